// change_log.hpp — records which elements of a part were written, so that only these are looked at again.
#pragma once
#include "base/open_table.hpp"
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

class ChangeLog {
public:
  static constexpr int32_t beyond = -1; ///< in place of an element of another part, one side of which was written

  struct Moment {
    uint64_t era = 0; ///< of none
    size_t at = 0;
  };
  /// Recording begins here.
  void keep() { kept_ = true; }
  bool kept() const { return kept_; }
  void add(int32_t element) {
    if (kept_)
      written_.push_back(element);
  }
  Moment now() const { return {era_, written_.size()}; }
  /// Elements written since then, each once, ascending. False when they are not known: it may be all of them.
  bool since(Moment then, std::vector<int32_t>& out) const {
    if (!kept_ || then.era != era_)
      return false;
    met_.clear(); // most are written many times
    for (size_t i = then.at; i < written_.size(); ++i)
      met_(written_[i]);
    out = met_.met();
    std::sort(out.begin(), out.end());
    return true;
  }
  /// Any element may have been written.
  void forget() {
    written_.clear();
    ++era_;
  }
  size_t size() const { return written_.size(); }

private:
  bool kept_ = false;
  uint64_t era_ = 1;
  std::vector<int32_t> written_;
  mutable SmallNumbers met_; ///< of since()
};

} // namespace molmesh::optimize
