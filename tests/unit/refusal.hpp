// refusal.hpp — what a bad input is answered with.
#pragma once
#include "base/error.hpp"
#include <catch2/catch.hpp>
#include <string>

namespace molmesh::test {

/// The one line with which `action` is refused, and the quantities it names, as in "…[margin][box]"; the empty text
/// when it is not.
template <class Action>
std::string refusal(Status status, Action action) {
  try {
    action();
  } catch (const Error& e) {
    std::string line = e.what();
    CHECK(e.status == status);
    CHECK(line.find('\n') == std::string::npos);
    for (const std::string& quantity : e.quantities)
      line += '[' + quantity + ']';
    return line;
  }
  return "";
}

} // namespace molmesh::test
