// hierjoin.cpp — a plan (.join) and the hierarchies (.hier) that it names to one hierarchy.
#include "tools/options/hierjoin.hpp"
#include "formats/hier/hier.hpp"
#include "formats/hier/text.hpp"
#include "formats/join/join.hpp"
#include "formats/pdb/hier_selection.hpp"
#include "formats/pdb/operators.hpp"
#include "formats/pdb/sha256.hpp"
#include "formats/read_all.hpp"
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

using namespace molmesh;

namespace {

/// Beside the plan, unless the name says where it is; not the output: no file is read and written.
std::string path_of(const Options& o, const std::string& file, const std::string& where) {
  const size_t folder = o.input == "-" || file[0] == '/' ? 0 : o.input.rfind('/') + 1;
  const std::string path = o.input.substr(0, folder) + file;
  if (cli::same_file(path, o.output))
    fail(Status::usage, where + ": found " + path + ", which is the output, expected another file");
  return path;
}

/// What goes wrong with a file that a plan names begins with the plan's line.
template <class Read>
auto in_line(const std::string& where, Read read) {
  try {
    return read();
  } catch (const Error& e) {
    fail(e.status, where + ": " + e.what(), e.quantities);
  }
}

/// Each file once; `sources` gets theirs.
void read_pieces(const Options& o, formats::JoinPlan& plan, std::string& sources) {
  std::map<std::string, std::shared_ptr<const Hierarchy>> known;
  std::vector<std::string> levels = {"chain", "residue"}; // of bodies: those of the first file
  for (size_t p = 0; p < plan.piece.size(); ++p) {
    const std::string& where = plan.piece[p].where;
    if (plan.body[p])
      continue;
    std::shared_ptr<const Hierarchy>& h = known[path_of(o, plan.file[p], where)];
    if (!h) {
      h = in_line(where, [&] {
        cli::InputFile file(path_of(o, plan.file[p], where));
        return std::make_shared<const Hierarchy>(formats::read_hier(file.stream(), file.name()));
      });
      sources += '\n' + h->source;
      if (known.size() == 1)
        levels = levels_below_domains(*h);
    }
    plan.piece[p].hierarchy = h;
  }
  for (size_t p = 0; p < plan.piece.size(); ++p)
    if (plan.body[p])
      plan.piece[p].hierarchy =
          std::make_shared<const Hierarchy>(hierarchy_of(*plan.body[p], plan.file[p], levels));
}

std::string counted(size_t n, const std::string& one, const std::string& many = "") {
  return std::to_string(n) + " " + (n == 1 ? one : many.empty() ? one + "s" : many);
}

/// In all; empty: the atoms have none.
std::string charge_of(const Hierarchy& h) {
  double sum = 0;
  const bool any = std::any_of(h.atom.begin(), h.atom.end(), [](const Atom& a) { return !std::isnan(a.charge); });
  for (const Atom& a : h.atom)
    sum += std::isnan(a.charge) ? 0 : a.charge;
  std::ostringstream text;
  text << ", total charge " << std::round(1e6 * sum) / 1e6 + 0.0 << " e"; // + 0.0: not -0
  return any ? text.str() : "";
}

void report(cli::Run& r, const formats::JoinPlan& plan, const Hierarchy& h, const std::vector<Joined>& joined) {
  int64_t copies = 0, carved = 0;
  for (size_t p = 0; p < joined.size(); ++p) {
    copies += joined[p].copies;
    std::string names;
    int64_t all = 0;
    for (const auto& [name, n] : joined[p].carved) {
      names += (names.empty() ? "" : ", ") + std::to_string(n) + " " + name;
      all += n;
    }
    carved += all;
    if (all > 0)
      r.note(plan.piece[p].where + ": carved " + counted(static_cast<size_t>(all), "residue") + ": " + names);
  }
  const size_t bodies = h.body.size(), atoms = h.atom.size() - bodies;
  r.made = "joined " + counted(joined.size(), "piece") + " in " + std::to_string(copies) +
           (copies == 1 ? " copy: " : " copies: ") + counted(atoms, "atom") +
           (bodies > 0 ? ", " + counted(bodies, "body without atoms", "bodies without atoms") : "") + charge_of(h);
  r.counts = {{"pieces", joined.size()},
              {"copies", copies},
              {"atoms", atoms},
              {"bodies", bodies},
              {"carved_residues", carved}};
  for (const Level& l : h.level)
    r.counts["groups"][l.name] = l.group.size();
}

Status run(const Options& o, cli::Run& r) {
  r.phase("read");
  cli::InputFile in(o.input);
  const std::string text = formats::read_all(in.stream(), in.name());
  std::istringstream lines(text);
  const auto operators = [&](const std::string& file, const std::string& id, const std::string& where) {
    return in_line(where, [&] {
      cli::InputFile structure(path_of(o, file, where));
      return formats::read_operators(structure.stream(), structure.name(), id);
    });
  };
  formats::JoinPlan plan = formats::read_join(lines, in.name(), operators);
  for (const std::string& rule : o.rules)
    plan.rule.push_back(parse_rule(rule, "-r '" + rule + "'", Status::usage));
  if (o.carve)
    for (size_t p = 1; p < plan.piece.size(); ++p)
      if (!plan.body[p] && !(plan.piece[p].carve > 0))
        plan.piece[p].carve = *o.carve;
  std::string sources;
  read_pieces(o, plan, sources);

  r.phase("join");
  std::vector<Joined> joined;
  Hierarchy h = join(plan.piece, o.clash == "number" ? Clash::number : Clash::refuse, joined);
  formats::apply_rules(h, plan.rule);
  formats::percent_encode(h.source, o.input == "-" ? "stdin" : o.input.substr(o.input.rfind('/') + 1));
  h.source += " sha256:" + formats::sha256(text + sources);

  r.phase("write");
  cli::OutputFile out(o.output);
  formats::write_hier(out.stream(), h);
  r.complete(out);
  report(r, plan, h, joined);
  return Status::good;
}

} // namespace

int main(int argc, char** argv) {
  return cli::run_main<Options>("hierjoin", "Several molecular hierarchies (.hier) into one, as a plan says.", argc,
                                argv, describe, run);
}
