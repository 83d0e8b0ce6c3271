// join_fuzz.cpp — plans of pieces and bodies; every piece is one atom, and what a plan says is joined.
#include "base/error.hpp"
#include "formats/hier/hier.hpp"
#include "formats/join/join.hpp"
#include <sstream>

using namespace molmesh;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
  const auto one = [](const std::string&, const std::string&, const std::string&) { return std::vector{Rigid{}}; };
  try {
    formats::JoinPlan plan = formats::read_join(in, "fuzz", one);
    Hierarchy atom;
    atom.level = {{"chain", {{"A", 1, 0, 1}}}, {"residue", {{"G:1", 1, 0, 1}}}};
    atom.atom.push_back({{0, 0, 0}, 1.5});
    const auto shared = std::make_shared<const Hierarchy>(atom);
    size_t copies = 0;
    for (size_t p = 0; p < plan.piece.size(); ++p) {
      plan.piece[p].hierarchy =
          plan.body[p]
              ? std::make_shared<const Hierarchy>(hierarchy_of(*plan.body[p], plan.file[p], {"chain", "residue"}))
              : shared;
      copies += plan.piece[p].copies.size();
    }
    if (copies > 2000)
      return 0;
    std::vector<Joined> joined;
    const Hierarchy h = join(plan.piece, Clash::number, joined);
    std::stringstream text;
    formats::write_hier(text, h); // and it keeps its own rules
    formats::read_hier(text, "written");
  } catch (const Error& e) {
    if (std::string(e.what()).find("written") == 0)
      std::abort();
  }
  return 0;
}
