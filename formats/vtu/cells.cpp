// cells.cpp — numbers to places, values to arrays.
#include "formats/vtu/cells.hpp"
#include "formats/vtu/foreign.hpp"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace molmesh::formats {

bool Numbering::close() {
  bool consecutive = true;
  for (size_t i = 1; i < number_.size() && consecutive; ++i)
    consecutive = number_[i] == number_[i - 1] + 1;
  if (consecutive)
    return true;
  order_.resize(number_.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(), [&](int32_t a, int32_t b) { return number_[a] < number_[b]; });
  std::sort(number_.begin(), number_.end());
  return std::adjacent_find(number_.begin(), number_.end()) == number_.end();
}

int32_t Numbering::place(int64_t number) const {
  if (number_.empty())
    return -1;
  if (order_.empty())
    return number >= number_.front() && number <= number_.back() ? static_cast<int32_t>(number - number_.front())
                                                                 : -1;
  const auto at = std::lower_bound(number_.begin(), number_.end(), number);
  return at != number_.end() && *at == number ? order_[at - number_.begin()] : -1;
}

void Values::set(size_t i, double v) {
  if (real_.empty()) {
    if (v == std::floor(v) && std::fabs(v) < 2147483648.) {
      integer_[i] = static_cast<int32_t>(v);
      return;
    }
    make_real();
  }
  real_[i] = v;
}

void Values::make_real() {
  real_.assign(integer_.begin(), integer_.end());
  integer_ = {};
}

bool Values::all_zero() const {
  return std::all_of(integer_.begin(), integer_.end(), [](int32_t v) { return v == 0; }) &&
         std::all_of(real_.begin(), real_.end(), [](double v) { return v == 0; });
}

CellArray joined(std::string name, Values tets, Values triangles) {
  if (!tets.real_.empty() && triangles.real_.empty())
    triangles.make_real();
  if (tets.real_.empty() && !triangles.real_.empty())
    tets.make_real();
  CellArray a{std::move(name), std::move(tets.integer_), std::move(tets.real_)};
  a.integer.insert(a.integer.end(), triangles.integer_.begin(), triangles.integer_.end());
  a.real.insert(a.real.end(), triangles.real_.begin(), triangles.real_.end());
  return a;
}

void ForeignCells::pass_over(const std::string& what) {
  constexpr size_t most = 10;
  if (notes_.passed_over.size() < most)
    notes_.passed_over.push_back(what);
  else if (notes_.passed_over.size() == most)
    notes_.passed_over.push_back("more");
}

void ForeignCells::spend(uint64_t bytes, const std::string& what) {
  spent_ += bytes;
  if (spent_ > 8 * in_.size() + (uint64_t{16} << 20))
    in_.refuse("R8", "with " + what + " the values of cells take over 8 times the size of the file");
}

std::string no_tetrahedron(bool triangles, const std::string& way) {
  return triangles ? "a surface, expected a mesh of tetrahedra: " + way : "no tetrahedron";
}

TetMesh ForeignCells::finish(const MeshReading& as) {
  if (m.tet.empty())
    in_.refuse("R7", no_tetrahedron(!m.tri.empty(),
                                    "fill it with tetrahedra first, as tetgen -pqg does, whose .mesh is read"));
  m.region.assign(m.tet.size(), 1);
  m.boundary.assign(m.tri.size(), 1);
  // Arrays of the names that we use ourselves, as in our own meshes that came through another program.
  const auto take = [&](const char* name, size_t begin, size_t n, int32_t least, std::vector<int32_t>& to) {
    const auto a =
        std::find_if(m.cell_array.begin(), m.cell_array.end(), [&](const CellArray& c) { return c.name == name; });
    if (a == m.cell_array.end())
      return false;
    const auto from = a->integer.begin() + static_cast<std::ptrdiff_t>(a->real.empty() ? begin : 0);
    const auto stop = from + static_cast<std::ptrdiff_t>(a->real.empty() ? n : 0);
    if (!a->real.empty() || std::any_of(from, stop, [&](int32_t v) { return v < least; })) {
      a->name += "_of_file";
      return false;
    }
    to.assign(from, stop);
    m.cell_array.erase(a);
    return true;
  };
  notes_.region_missing = !take("region", 0, m.tet.size(), 1, m.region);
  notes_.boundary_missing = !take("boundary", m.tet.size(), m.tri.size(), 1, m.boundary);
  take("part", 0, m.tet.size(), 0, m.part);
  complete_mesh(m, in_.file(), as, notes_);
  return std::move(m);
}

} // namespace molmesh::formats
