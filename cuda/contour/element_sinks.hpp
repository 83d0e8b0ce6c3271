// element_sinks.hpp — collects the elements of all runs in one array.
#pragma once
#include "contour/elements/elements.hpp"
#include "cuda/contour/element_items.hpp"
#include "cuda/par/backend.hpp"
#include <utility>
#include <vector>

namespace molmesh::cuda {

/// What a run of leaves or edges makes.
template <par::Launcher Backend>
struct ElementRun {
  template <class T>
  using Array = typename Backend::template Array<T>;
  Array<Tet> tet;
  Array<Tri> tri;
  Array<Sides> tri_sides;
  Array<int32_t> boundary;
  Array<Vec3d> point;
};

/// The parts one after the other; they go as they are copied.
template <class T, par::Launcher Backend>
typename Backend::template Array<T> joined(Backend& b, std::vector<typename Backend::template Array<T>>& part,
                                           const std::vector<int64_t>& count) {
  if (part.size() == 1)
    return std::move(part[0]);
  int64_t n = 0;
  for (const int64_t c : count)
    n += c;
  auto all = b.template array<T>(n);
  int64_t at = 0;
  for (size_t i = 0; i < part.size(); ++i) {
    b.for_n("copy", count[i], par::CopyItems<T>{part[i].data(), all.data() + at},
            {2. * double(count[i]) * sizeof(T)});
    at += count[i];
    part[i] = {};
  }
  return all;
}

/// All in the Backend's memory.
template <par::Launcher Backend>
class SinkOnDevice {
public:
  explicit SinkOnDevice(Backend& b) : b_(b) {}
  void take(ElementRun<Backend> run) { runs_.push_back(std::move(run)); }
  /// position: of the complex, then the new points.
  contour::ElementArrays<Backend> elements(const ComplexView& c) {
    contour::ElementArrays<Backend> out;
    out.tet = all(&ElementRun<Backend>::tet);
    out.tri = all(&ElementRun<Backend>::tri);
    out.tri_sides = all(&ElementRun<Backend>::tri_sides);
    out.boundary = all(&ElementRun<Backend>::boundary);
    const auto point = all(&ElementRun<Backend>::point);
    const int64_t own = c.vertices(), more = point.size();
    out.position = b_.template array<Vec3d>(own + more);
    b_.for_n("copy", own, par::CopyItems<Vec3d>{c.position, out.position.data()}, {48. * double(own)});
    b_.for_n("copy", more, par::CopyItems<Vec3d>{point.data(), out.position.data() + own}, {48. * double(more)});
    return out;
  }

private:
  template <class T>
  using Array = typename Backend::template Array<T>;
  template <class T>
  Array<T> all(Array<T> ElementRun<Backend>::*member) {
    std::vector<Array<T>> part;
    std::vector<int64_t> count;
    for (ElementRun<Backend>& run : runs_) {
      part.push_back(std::move(run.*member));
      count.push_back(part.back().size());
    }
    return joined<T>(b_, part, count);
  }
  Backend& b_;
  std::vector<ElementRun<Backend>> runs_;
};

} // namespace molmesh::cuda
