// par_test.cpp — same results at any number of threads.
#include "par/launcher.hpp"
#include "par/pages.hpp"
#include "par/par.hpp"
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <random>
#include <stdexcept>
#include <thread>

using namespace molmesh;

TEST_CASE("reduce gives the same bits at any number of threads") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> u(-1e9, 1);
  std::vector<double> v(100'003);
  for (double& x : v)
    x = u(random);
  const auto sum = [&](int threads) {
    return par::reduce(
        static_cast<int64_t>(v.size()), threads, 0.0, [&](int64_t i) { return v[i]; },
        [](double a, double b) { return a + b; });
  };
  const double one = sum(1);
  for (int threads : {2, 3, 5, 8})
    CHECK(sum(threads) == one);
}

TEST_CASE("reduce of bool loses nothing of chunks side by side") {
  constexpr int64_t n = 999'999; // odd: so is the number of chunks that say so
  for (int threads : {1, 2, 4, 8})
    CHECK(par::reduce(
        n, threads, false, [](int64_t) { return true; }, [](bool a, bool b) { return a != b; }, 1));
}

TEST_CASE("sort agrees with std::sort") {
  std::mt19937_64 random(7);
  for (size_t n : {0u, 1u, 1000u, 200'001u}) {
    std::vector<uint64_t> v(n);
    for (uint64_t& x : v)
      x = random() % 1000;
    std::vector<uint64_t> expected = v;
    std::sort(expected.begin(), expected.end());
    for (int threads : {1, 2, 5}) {
      std::vector<uint64_t> sorted = v;
      par::sort(sorted, threads);
      CHECK(sorted == expected);
    }
  }
}

TEST_CASE("an exception in a loop reaches the caller") {
  for (int threads : {1, 4})
    CHECK_THROWS_AS(par::for_n(10'000, threads, 10,
                               [](int64_t i) {
                                 if (i == 7777)
                                   throw std::runtime_error("x");
                               }),
                    std::runtime_error);
}

TEST_CASE("what runs while threads start runs once, on the calling thread, and may throw") {
  for (int threads : {1, 2, 5}) {
    int runs = 0;
    std::thread::id where;
    par::start_threads_during(threads, [&] {
      ++runs;
      where = std::this_thread::get_id();
    });
    CHECK(runs == 1);
    CHECK(where == std::this_thread::get_id());
    CHECK_THROWS_AS(par::start_threads_during(threads, [] { throw std::runtime_error("x"); }), std::runtime_error);
  }
}

TEST_CASE("exclusive_scan turns counts into offsets") {
  std::vector<int64_t> count{3, 0, 2, 5};
  CHECK(par::exclusive_scan(count) == 10);
  CHECK(count == std::vector<int64_t>{0, 3, 3, 5});
}

TEST_CASE("select keeps the order") {
  const auto third = [](int64_t i) { return i % 3 == 1; };
  for (int threads : {1, 2, 5}) {
    CHECK(par::select(0, threads, third).empty());
    const auto found = par::select(100'000, threads, third);
    REQUIRE(found.size() == 33'333);
    for (size_t i = 0; i < found.size(); ++i)
      REQUIRE(found[i] == static_cast<int32_t>(3 * i + 1));
  }
}

TEST_CASE("place_by is a stable sort that leaves out negative keys") {
  std::mt19937_64 random(3);
  for (const int64_t keys : {int64_t{1}, int64_t{70}, int64_t{1'000'000}})
    for (size_t n : {0u, 10u, 300'000u}) {
      std::vector<int64_t> key(n);
      for (int64_t& k : key)
        k = static_cast<int64_t>(random() % static_cast<uint64_t>(keys + 1)) - 1;
      std::vector<int64_t> expected;
      for (size_t i = 0; i < n; ++i)
        if (key[i] >= 0)
          expected.push_back(static_cast<int64_t>(i));
      std::stable_sort(expected.begin(), expected.end(), [&](int64_t a, int64_t b) { return key[a] < key[b]; });
      for (int threads : {1, 3}) {
        std::vector<int64_t> placed;
        par::place_by(
            static_cast<int64_t>(n), keys, threads, [&](int64_t i) { return key[i]; },
            [&](int64_t slots) { placed.assign(static_cast<size_t>(slots), -1); },
            [&](int64_t slot, int64_t i) { placed[slot] = i; });
        CHECK(placed == expected);
      }
    }
}

namespace {

struct WhoRuns {
  static constexpr int64_t grain = 4;
  std::atomic<int>* elsewhere;
  std::thread::id caller = std::this_thread::get_id();
  void operator()(int64_t) const {
    *elsewhere += std::this_thread::get_id() != caller;
    std::this_thread::sleep_for(std::chrono::microseconds(200)); // long enough for others to take part
  }
};

} // namespace

TEST_CASE("a launcher's short loops run on the calling thread") {
  par::HostLauncher launcher(4);
  std::atomic<int> elsewhere = 0;
  launcher.for_n("short", WhoRuns::grain * par::HostLauncher::least_pieces - 1, WhoRuns{&elsewhere});
  CHECK(elsewhere == 0);
  launcher.for_n("long", 16 * WhoRuns::grain * par::HostLauncher::least_pieces, WhoRuns{&elsewhere});
  CHECK((elsewhere > 0) == par::has_threads());
}

TEST_CASE("memory that is asked for keeps what it and its neighbours hold", "[slow]") {
  std::vector<LargeArray<uint8_t>> array;
  const auto pattern = [](size_t a, size_t i) { return static_cast<uint8_t>(31 * a + i % 251); };
  for (const size_t n : {100u, 5000u, 200'000u, 3'000'001u, 9u}) {
    LargeArray<uint8_t> one(n);
    for (size_t i = 0; i < n; ++i)
      one[i] = pattern(array.size(), i);
    array.push_back(std::move(one));
  }
  for (const int threads : {1, 2})
    for (LargeArray<uint8_t>& one : array)
      par::prepare_pages(one.data() + one.size() / 3, one.size() / 2, threads);
  for (size_t a = 0; a < array.size(); ++a)
    for (size_t i = 0; i < array[a].size(); ++i)
      REQUIRE(array[a][i] == pattern(a, i));
}

TEST_CASE("arrays are made anew in the memory that they have, or in enough of it") {
  std::vector<int32_t> v{1, 2, 3};
  v.reserve(300'000);
  const int32_t* const before = v.data();
  par::resize_pages(v, 200'000, 2);
  CHECK(v.size() == 200'000);
  CHECK(v.data() == before);
  par::resize_pages(v, 700'000, 2);
  CHECK(v.size() == 700'000);
  v.back() = 7;
  par::resize_pages(v, 2, 2);
  CHECK(v.size() == 2);
}
