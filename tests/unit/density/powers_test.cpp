// powers_test.cpp — powers on the points of a block against pow() in double precision.
#include "density/values/block_sums_simd.hpp"
#include "density/values/power_table.hpp"
#include "unit/instruction_sets.hpp"
#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace molmesh;

TEST_CASE("powers of sums are those of pow() within 3e-6, by tables with AVX-512 and by logarithms") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> ln(-40, 40), any(0, 1);
  std::vector<double> exponents{1e-3, 0.05, 0.1, 0.3, 0.5, 0.7, 0.999, 1.0001, 1.5, 3};
  for (int i = 0; i < 200; ++i) // more than a thread keeps tables of
    exponents.push_back(any(random));
  test::with_every_instruction_set([&] {
    bool zero = true;
    double worst = 0, worst_by_table = 0; // of exponents below 1
    for (int turn = 0; turn < 2; ++turn)
      for (const double exponent : exponents) {
        const auto p = static_cast<float>(exponent);
        std::vector<float> from(512), to(512, 0.0f);
        for (float& v : from)
          v = static_cast<float>(std::exp(ln(random) / std::max(1.0, exponent)));
        from[7] = 0;
        from[8] = 1;
        from[9] = 0.99999994f;
        const std::vector<float> x = from;
        density::raise_group(p, 0, from.data(), to.data());
        for (size_t i = 0; i < 512; ++i) {
          zero = zero && from[i] == 0 && (x[i] > 0 || to[i] == 0);
          const double expected = x[i] > 0 ? std::pow(double(x[i]), double(p)) : 0;
          if (expected > 0)
            (exponent < 1 ? worst_by_table : worst) = std::max(
                exponent < 1 ? worst_by_table : worst, std::abs(to[i] / expected - 1) / std::max(1.0, exponent));
        }
      }
    CHECK(zero);
    CHECK(worst < 3e-6); // the logarithm of a large number has an ulp of its own
    CHECK(worst_by_table < (std::string(density::instruction_set()).starts_with("AVX3") ? 7e-7 : 3e-6));
  });
}

TEST_CASE("powers in double precision are those of pow() within 1e-10") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> ln(-690, 690), any(0, 1);
  std::vector<double> exponents{1e-3, 0.05, 0.1, 0.3, 0.5, 0.7, 0.999, 1.0001, 1.5, 3};
  for (int i = 0; i < 60; ++i)
    exponents.push_back(any(random));
  test::with_every_instruction_set([&] {
    double worst = 0;
    for (int turn = 0; turn < 2; ++turn)
      for (const double p : exponents) {
        std::vector<double> from(512), to(512, 0.0);
        for (double& v : from)
          v = std::exp(ln(random) / std::max(1.0, p));
        from[7] = 0;
        const std::vector<double> x = from;
        density::raise_group(p, 0.0, from.data(), to.data());
        for (size_t i = 0; i < 512; ++i)
          worst = std::max(worst, x[i] > 0 ? std::abs(to[i] / std::pow(x[i], p) - 1) : to[i]);
      }
    CHECK(worst < 1e-10);
  });
}

TEST_CASE("a table of a power holds its parts, and one evaluation of them is within 4e-7") {
  for (const float p : {0.01f, 0.1f, 0.3f, 0.5f, 0.9f, 0.99f}) {
    const density::PowerTable t = density::power_table(p);
    CHECK(t.p == p);
    for (int i = 0; i < 16; ++i) {
      CHECK(t.low[i] == Approx(std::pow(2.0, double(p) * i)).epsilon(1e-7));
      CHECK(t.high[i] == Approx(std::pow(2.0, double(p) * (16 * i - 127))).epsilon(1e-7));
    }
    for (double m = 1; m < 2; m += 1e-3) {
      double sum = 0;
      for (size_t i = density::PowerTable::terms; i-- > 0;)
        sum = sum * m + double(t.polynomial[i]);
      REQUIRE(std::abs(sum / std::pow(m, double(p)) - 1) < 4e-7);
    }
  }
}
