// index_table_test.cpp — indices are found by keys, whatever their hashes.
#include "base/index_table.hpp"
#include <catch2/catch.hpp>
#include <functional>

using namespace molmesh;

TEST_CASE("an index table finds what it was given, and nothing when cleared") {
  const std::function<size_t(uint32_t)> hashes[] = {
      [](uint32_t key) { return size_t{key} * 0x9E3779B97F4A7C15u >> 20; },
      [](uint32_t key) { return size_t{key % 3}; }};
  for (const auto& hash : hashes) {
    IndexTable table;
    std::vector<uint32_t> key;
    const auto index_of = [&](uint32_t k) {
      return table.find_or_add(
          static_cast<uint32_t>(key.size()), hash(k), [&](uint32_t i) { return key[i] == k; },
          [&](uint32_t i) { return hash(key[i]); });
    };
    for (int round = 0; round < 2; ++round) {
      for (uint32_t i = 0; i < 1000; ++i) {
        REQUIRE(index_of(7 * i) == i);
        key.push_back(7 * i);
        REQUIRE(index_of(7 * (i / 2)) == i / 2);
      }
      key.clear();
      table.clear();
    }
  }
}
