// helpers_test.cpp — threads without items of their own take part in what others share.
#include "par/helpers.hpp"
#include "par/par.hpp"
#include <atomic>
#include <catch2/catch.hpp>
#include <optional>
#include <stdexcept>
#include <thread>

using namespace molmesh;

TEST_CASE("a thread that waits takes part, and goes when none is busy") {
  par::Helpers helpers;
  std::optional<par::Helpers::Busy> busy(helpers);
  CHECK(!helpers.any_idle());
  std::thread other([&] { helpers.help(); });
  while (!helpers.any_idle())
    std::this_thread::yield();
  std::atomic<int> joined{0};
  std::atomic<bool> out{false};
  helpers.share(
      [&] {
        while (joined == 0)
          std::this_thread::yield();
      },
      [&] {
        ++joined;
        out = true;
      });
  CHECK(out);
  CHECK(joined == 1); // nothing of it was left after the first time
  busy.reset();
  other.join();
  helpers.help(); // nobody is busy
}

TEST_CASE("all of a shared loop is done once, whoever has items left") {
  for (const int threads : {1, 2, 5}) {
    par::Helpers helpers;
    std::atomic<int> next{0};
    std::vector<std::atomic<int>> done(300);
    par::for_n(threads, threads, 1, [&](int64_t) {
      for (const par::Helpers::Busy busy(helpers);;) {
        const int item = next++;
        if (item >= 3)
          break;
        std::atomic<int> at{0};
        const auto work = [&] {
          for (int k; (k = at++) < 100;)
            ++done[100 * item + k];
        };
        helpers.share(work, work);
      }
      helpers.help();
    });
    for (const auto& d : done)
      CHECK(d == 1);
  }
}

TEST_CASE("what a helper throws is its own, and the thread that shared goes on") {
  par::Helpers helpers;
  std::optional<par::Helpers::Busy> busy(helpers);
  bool thrown = false;
  std::thread other([&] {
    try {
      helpers.help();
    } catch (const std::runtime_error&) {
      thrown = true;
    }
  });
  while (!helpers.any_idle())
    std::this_thread::yield();
  std::atomic<bool> joined{false};
  helpers.share(
      [&] {
        while (!joined)
          std::this_thread::yield();
      },
      [&] {
        joined = true;
        throw std::runtime_error("no memory");
      });
  other.join();
  CHECK(thrown);
}
