// mend.cpp — sweeps over what is bent or bad in a part.
#include "optimize/search/mend.hpp"
#include "optimize/schedule/element_pass.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::optimize {

std::vector<int32_t> Mending::below(float goal, const std::vector<int32_t>& of) const {
  std::vector<int32_t> list;
  for (const int32_t t : of)
    if (m_.element[t].alive() && m_.element[t].q < goal)
      list.push_back(t);
  return list;
}

std::vector<int32_t> Mending::bad() {
  return below(FaultCount::share * pass_.goal, below_goal_());
}

std::vector<int32_t> Mending::elements() const {
  std::vector<int32_t> all;
  for (const int32_t t : slots_)
    if (m_.element[t].alive())
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
      if (m_.element[t].alive())
        straighten_element(editor_, m_, t);
  }
}

void Mending::mend(int rounds, double hopeless) {
  editor_.straighten = false;
  editor_.bold = bend;
  editor_.loose = loose;
  editor_.goal = pass_.goal;
  for (int k = 0, idle = 0; k < rounds && idle < 2; ++k) { // after two in vain, one of each kind, all are
    if (k > 0 && k * deficit() > hopeless)
      return;
    const int64_t done = editor_.counts.total();
    editor_.worst_first = (k % 2 == 0) == pass_.worst_first;
    std::vector<int32_t> list = below_goal_();
    if (list.empty())
      return;
    for (int sweep = 0; sweep < 4 && !list.empty(); ++sweep) {
      sort_worst_first(m_, list);
      editor_.changed.clear();
      for (const int32_t t : list)
        if (m_.element[t].alive() && m_.element[t].q < pass_.goal)
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
      if (m_.element[t].alive() && editor_.bent(t, f)) {
        editor_.changed.push_back(t);
        break;
      }
  flatten();
}

double Mending::deficit() {
  double sum = 0;
  for (const int32_t t : bad())
    sum += 1.2 - std::sqrt(m_.element[t].q / pass_.goal);
  return sum;
}

} // namespace molmesh::optimize
