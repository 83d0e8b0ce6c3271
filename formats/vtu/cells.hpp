// cells.hpp — collects the cells of a mesh of another program; what readers of several formats do alike.
#pragma once
#include "formats/text_in.hpp"
#include "formats/vtu/vtu.hpp"
#include <vector>

namespace molmesh::formats {

/// Places of numbered things: a file may number its points and elements as it likes.
class Numbering {
public:
  void reserve(size_t n) { number_.reserve(n); }
  void add(int64_t number) { number_.push_back(number); }
  /// After the last add. False where a number occurs twice.
  bool close();
  /// -1: no such number.
  int32_t place(int64_t number) const;
  size_t size() const { return number_.size(); }

private:
  std::vector<int64_t> number_; ///< as added; ascending after close() where order_ is not empty
  std::vector<int32_t> order_;  ///< places of the ascending numbers; empty: they came one after the other
};

/// Values of one array while a file is read: integers, until one is none.
class Values {
public:
  void resize(size_t n) { real_.empty() ? integer_.resize(n) : real_.resize(n); }
  void set(size_t i, double v);
  void push(double v) { resize(size() + 1), set(size() - 1, v); }
  void push_integer(int64_t v) { push(static_cast<double>(v)); }
  size_t size() const { return real_.empty() ? integer_.size() : real_.size(); }
  double get(size_t i) const { return real_.empty() ? integer_[i] : real_[i]; }
  bool all_zero() const;

private:
  friend CellArray joined(std::string name, Values tets, Values triangles);
  void make_real();
  std::vector<int32_t> integer_;
  std::vector<double> real_;
};

/// Values of tetrahedra and of triangles as one array.
CellArray joined(std::string name, Values tets, Values triangles);

/// What R7 says of a file without tetrahedra. triangles: it has some, so that it is a surface. way: what to do with
/// that.
std::string no_tetrahedron(bool triangles, const std::string& way);

/// Points, tetrahedra and triangles of a file that is no .vtu; regions and labels are found by complete_mesh().
class ForeignCells {
public:
  ForeignCells(TextIn& in, MeshNotes& notes) : in_(in), notes_(notes) {
    notes_ = {};
    notes_.region_missing = notes_.boundary_missing = notes_.isovalue_missing = true;
  }
  void add_point(Vec3d p) { m.point.push_back(p); }
  /// corner(i): point i of the cell.
  template <class Corner>
  void add_tet(Corner&& corner) {
    if (m.tet.size() == size_t{1} << 29)
      in_.refuse("R10", "over 2^29 tetrahedra");
    m.tet.push_back({corner(0), corner(1), corner(2), corner(3)});
  }
  template <class Corner>
  void add_tri(Corner&& corner) {
    m.tri.push_back({corner(0), corner(1), corner(2)});
  }
  void drop(int64_t n = 1) { notes_.dropped_cells += n; }
  void pass_over(const std::string& what);
  /// R7: cells of this kind are not taken.
  [[noreturn]] void refuse_kind(int64_t cell, const std::string& kind) const {
    in_.refuse("R7", "cell " + std::to_string(cell) + " is a " + kind +
                         ", expected tetrahedra and triangles of straight edges");
  }
  /// Memory for values beyond the cells themselves: bounded by the file's size.
  void spend(uint64_t bytes, const std::string& what);
  /// The mesh, complete.
  TetMesh finish(const MeshReading& as);

  TetMesh m;

private:
  TextIn& in_;
  MeshNotes& notes_;
  uint64_t spent_ = 0;
};

} // namespace molmesh::formats
