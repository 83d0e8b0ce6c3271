// mend.cpp — sweeps over what is bent or bad in a part, and a search among operations that make it worse at first.
#include "improve/mend.hpp"
#include "improve/element_pass.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::improve {

std::vector<int32_t> Mending::below(float goal, const std::vector<int32_t>& of) const {
  std::vector<int32_t> list;
  for (const int32_t t : of)
    if (m_.element[size_t(t)].alive() && m_.element[size_t(t)].q < goal)
      list.push_back(t);
  return list;
}

std::vector<int32_t> Mending::elements() const {
  std::vector<int32_t> all;
  for (const int32_t t : slots_)
    if (m_.element[size_t(t)].alive())
      all.push_back(t);
  return all;
}

void Mending::set_out() {
  editor_.straighten = true;
  editor_.bold = editor_.loose = false;
  editor_.goal = floor * pass_.goal;
}

void Mending::flatten() {
  for (int sweep = 0; sweep < 3 && !editor_.changed.empty(); ++sweep) {
    std::vector<int32_t> list;
    list.swap(editor_.changed);
    par::sort_unique(list, 1);
    for (const int32_t t : list)
      if (m_.element[size_t(t)].alive())
        straighten_element(editor_, m_, t);
  }
}

void Mending::mend(int rounds) {
  editor_.straighten = editor_.bold = false;
  editor_.loose = loose;
  editor_.goal = pass_.goal;
  for (int k = 0, idle = 0; k < rounds && idle < 2; ++k) { // after two in vain, one of each kind, all are
    const int64_t done = editor_.counts.total();
    editor_.worst_first = (k % 2 == 0) == pass_.worst_first;
    std::vector<int32_t> list = below(pass_.goal, slots_);
    if (list.empty())
      return;
    for (int sweep = 0; sweep < 4 && !list.empty(); ++sweep) {
      sort_worst_first(m_, list);
      editor_.changed.clear();
      for (const int32_t t : list)
        if (m_.element[size_t(t)].alive() && m_.element[size_t(t)].q < pass_.goal)
          improve_element(editor_, m_, t, pass_);
      list = below(pass_.goal, editor_.changed);
    }
    idle = editor_.counts.total() == done ? idle + 1 : 0;
  }
}

void Mending::straighten() {
  editor_.straighten = true;
  editor_.bold = false;
  editor_.loose = loose;
  editor_.goal = pass_.goal;
  editor_.changed.clear();
  for (const int32_t t : slots_)
    for (size_t f = 0; f < 4; ++f)
      if (m_.element[size_t(t)].alive() && editor_.bent(t, f)) {
        editor_.changed.push_back(t);
        break;
      }
  flatten();
}

double Mending::deficit() const {
  double sum = 0;
  for (const int32_t t : below(FaultCount::share * pass_.goal, slots_))
    sum += 1.2 - std::sqrt(m_.element[size_t(t)].q / pass_.goal);
  return sum;
}

// The worst elements and those beside them; with effort 4 all at the worst one's corners too.
std::vector<int32_t> Mending::worst() const {
  constexpr size_t most = 4;
  std::vector<int32_t> list = below(FaultCount::share * pass_.goal, slots_);
  sort_worst_first(m_, list);
  list.resize(std::min(list.size(), most));
  for (size_t i = 0, n = list.size(); i < n; ++i)
    for (const int32_t t : m_.element[size_t(list[i])].n)
      if (t >= 0 && editor_.owned(t) && std::find(list.begin(), list.end(), t) == list.end())
        list.push_back(t);
  if (pass_.effort < 4 || list.empty())
    return list;
  const Element first = m_.element[size_t(list[0])];
  for (const int32_t t : slots_) {
    const Element& e = m_.element[size_t(t)];
    if (e.alive() && std::any_of(first.v.begin(), first.v.end(), [&](int32_t v) { return e.find(v) >= 0; }) &&
        std::find(list.begin(), list.end(), t) == list.end())
      list.push_back(t);
  }
  return list;
}

constexpr int operations = 34;

bool Mending::operate(int32_t t, int k) {
  set_out();
  editor_.bold = true;
  editor_.changed.clear();
  const auto [i, j] = edges[size_t(k % 6)];
  switch (k / 6) {
  case 0:
    return editor_.remove_edge(t, i, j);
  case 1:
    return editor_.split(t, i, j);
  case 2:
    return editor_.contract(t, i, j);
  case 3:
    return editor_.contract(t, j, i);
  case 4:
    return editor_.merge(t, i, j);
  default:
    return editor_.swap_face(t, k % 6);
  }
}

void Mending::shake(FaultCount& faults, const Faults& before, int64_t bent_for_a_point, int& trials) {
  const int64_t off = faults().off;
  double least = deficit();
  for (bool done = true; done && least > 0;) {
    done = false;
    const Snapshot here = editor_.save(elements());
    for (const int32_t t : worst())
      for (int k = 0; k < operations && !done && trials > 0; ++k) {
        if (!operate(t, k))
          continue;
        --trials;
        set_out();
        flatten();
        mend(2);
        if (const double now = deficit(); now < 0.995 * least)
          if (const Faults f = faults(); f.off <= off && f.fewer_than(before, bent_for_a_point))
            done = true, least = now;
        if (!done)
          editor_.restore(here);
      }
  }
}

} // namespace molmesh::improve
