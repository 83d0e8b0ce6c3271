// assembly.cpp — the mesh on the host: elements in the order of their first vertex, points in that of their first
// use.
#include "contour/assembly/assembly.hpp"
#include "contour/assembly/assembly_passes.hpp"
#include "par/launcher.hpp"
#include <algorithm>
#include <utility>

namespace molmesh::contour {

namespace {

/// The mesh's own arrays.
class MeshArrays {
public:
  MeshArrays(TetMesh& mesh, int threads) : mesh_(mesh), threads_(threads) {}
  Tet* tets(int64_t n) { return room(mesh_.tet, n); }
  int32_t* regions(int64_t n) { return room(mesh_.region, n); }
  Vec3d* points(int64_t n) { return room(mesh_.point, n); }
  Tri* tris(int64_t n) { return room(mesh_.tri, n); }
  int32_t* boundaries(int64_t n) { return room(mesh_.boundary, n); }

  /// As number_points, in one pass over the elements. Runs of elements side by side: a point belongs to the
  /// first run that uses it.
  LargeArray<int32_t> number_points(const Tet* tet, int64_t tets, const ElementsView& e) {
    const int64_t runs = std::max(1, threads_), words = (e.positions + 63) / 64;
    std::vector<LargeArray<uint64_t>> used(static_cast<size_t>(runs)); // [points] bits
    std::vector<LargeArray<int32_t>> own(static_cast<size_t>(runs));   // points of each run, as first used
    par::for_n(runs, threads_, 1, [&](int64_t r) {
      LargeArray<uint64_t> bits(static_cast<size_t>(words), 0);
      LargeArray<int32_t> list;
      for (int64_t t = tets * r / runs; t < tets * (r + 1) / runs; ++t)
        for (int32_t v : tet[t])
          if (uint64_t& word = bits[v >> 6], bit = uint64_t{1} << (v & 63); !(word & bit)) {
            word |= bit;
            list.push_back(v);
          }
      used[r] = std::move(bits);
      own[r] = std::move(list);
    });
    par::for_n(words, threads_, [&](int64_t w) { // each run's becomes that of all before
      uint64_t before = 0;
      for (auto& of_run : used)
        before |= std::exchange(of_run[w], before);
    });
    par::for_n(runs - 1, threads_, 1, [&](int64_t r) {
      const LargeArray<uint64_t>& before = used[r + 1];
      std::erase_if(own[r + 1], [&](int32_t v) { return before[v >> 6] >> (v & 63) & 1; });
    });
    std::vector<int64_t> start;
    for (const auto& list : own)
      start.push_back(static_cast<int64_t>(list.size()));
    Vec3d* const point = points(par::exclusive_scan(start));
    LargeArray<int32_t> number;
    par::resize_pages(number, static_cast<size_t>(e.positions), threads_);
    for (int64_t r = 0; r < runs; ++r)
      par::for_n(static_cast<int64_t>(own[r].size()), threads_, [&](int64_t i) {
        const int32_t v = own[r][i];
        number[v] = static_cast<int32_t>(start[r] + i);
        point[start[r] + i] = e.position[v];
      });
    return number;
  }

private:
  template <class Array>
  auto room(Array& array, int64_t n) -> decltype(array.data()) {
    par::resize_pages(array, static_cast<size_t>(n), threads_);
    return array.data();
  }
  TetMesh& mesh_;
  int threads_;
};

} // namespace

TetMesh assemble(const Elements& elements, const Components& parts, Options::Meshed meshed, int threads) {
  par::HostLauncher launcher(threads);
  TetMesh mesh;
  MeshArrays room(mesh, threads);
  assemble(launcher, elements.view(), parts.region_of_vertex.data(),
           static_cast<int64_t>(parts.region_of_vertex.size()), wanted(meshed), room);
  return mesh;
}

} // namespace molmesh::contour
