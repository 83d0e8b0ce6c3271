// stars.hpp — the elements at each of some vertices.
#pragma once
#include "contour/detail/at.hpp"
#include "mesh/tet_mesh.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace molmesh::contour::detail {

struct Stars {
  std::vector<int32_t> vertex;  ///< the chosen ones
  std::vector<int32_t> number;  ///< [vertices] place in `vertex`, or -1
  std::vector<int64_t> first;   ///< [chosen + 1] into element
  std::vector<int32_t> element; ///< ascending at each vertex

  std::span<const int32_t> operator[](int32_t chosen) const {
    return {element.data() + first[at(chosen)], at(first[at(chosen + 1)] - first[at(chosen)])};
  }

  void gather(std::vector<int32_t> chosen, std::span<const Tet> tet, size_t vertices, int threads) {
    vertex = std::move(chosen);
    number.assign(vertices, -1);
    std::vector<uint8_t> is_chosen(vertices, 0); // small enough for the cache
    for (size_t i = 0; i < vertex.size(); ++i) {
      number[at(vertex[i])] = static_cast<int32_t>(i);
      is_chosen[at(vertex[i])] = 1;
    }
    constexpr int64_t batch = 1 << 16;
    const auto tets = static_cast<int64_t>(tet.size());
    std::vector<std::vector<int32_t>> near(at((tets + batch - 1) / batch)); // elements at a chosen vertex
    par::for_n(static_cast<int64_t>(near.size()), threads, 1, [&](int64_t b) {
      for (int64_t t = b * batch; t < std::min(tets, (b + 1) * batch); ++t) {
        const Tet& v = tet[at(t)];
        if (is_chosen[at(v[0])] | is_chosen[at(v[1])] | is_chosen[at(v[2])] | is_chosen[at(v[3])])
          near[at(b)].push_back(static_cast<int32_t>(t));
      }
    });
    const auto for_each = [&](auto f) {
      for (const std::vector<int32_t>& list : near)
        for (const int32_t t : list)
          for (const int32_t v : tet[at(t)])
            if (number[at(v)] >= 0)
              f(at(number[at(v)]), t);
    };
    first.assign(vertex.size() + 1, 0);
    for_each([&](size_t c, int32_t) { ++first[c]; });
    element.resize(at(par::exclusive_scan(first)));
    std::vector<int64_t> end = first;
    for_each([&](size_t c, int32_t t) { element[at(end[c]++)] = t; });
  }
};

} // namespace molmesh::contour::detail
