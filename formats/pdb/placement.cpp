// placement.cpp — fills the arrays; places the chains of an assembly.
#include "formats/pdb/placement.hpp"
#include "base/error.hpp"
#include "formats/pdb/chunks.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

namespace molmesh::formats {
namespace {

using Numbers = std::array<double, 12>;

Numbers numbers(const gemmi::Transform& t) {
  return {t.mat[0][0], t.mat[0][1], t.mat[0][2], t.vec.x,     t.mat[1][0], t.mat[1][1],
          t.mat[1][2], t.vec.y,     t.mat[2][0], t.mat[2][1], t.mat[2][2], t.vec.z};
}

bool is_finite(const Numbers& n) {
  return std::all_of(n.begin(), n.end(), [](double v) { return std::isfinite(v); });
}

/// Of the few decimals that old files have.
bool is_rotation(const gemmi::Mat33& m) {
  constexpr double rounding = 0.05;
  const gemmi::Mat33 product = m.transpose().multiply(m);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!(std::fabs(product[i][j] - (i == j)) <= rounding))
        return false;
  return m.determinant() > 0;
}

/// The residues of a chain that a generator names: all of them (PDB: by chain), or those of its subchains (mmCIF).
std::vector<int64_t> generated(const Flat& flat, const Flat::Chain& chain, const gemmi::Assembly::Gen& gen) {
  std::vector<int64_t> residues;
  const bool whole = gemmi::in_vector(chain.source->name.str(), gen.chains);
  const std::unordered_set<std::string> subchains(gen.subchains.begin(), gen.subchains.end());
  for (uint32_t r = chain.begin; r < chain.end; ++r)
    if (whole || subchains.count(flat.residue[r].source->subchain) > 0)
      residues.push_back(r);
  return residues;
}

/// Do the chains all have names of their own? Takes less memory than a table of the names.
bool are_unique(const Flat& flat, const std::vector<Placed>& placed) {
  std::vector<const std::string*> name;
  name.reserve(placed.size());
  for (const Placed& p : placed)
    name.push_back(&flat.chain[p.chain].source->name.str());
  std::sort(name.begin(), name.end(), [](const std::string* a, const std::string* b) { return *a < *b; });
  return std::adjacent_find(name.begin(), name.end(),
                            [](const std::string* a, const std::string* b) { return *a == *b; }) == name.end();
}

} // namespace

Vec3d Placed::position(Vec3d p) const {
  if (!transform)
    return p;
  const gemmi::Vec3 v = transform->apply(gemmi::Vec3(p.x, p.y, p.z));
  // As many decimals as coordinates have in the files that assemblies come from.
  const auto rounded = [](double x) { return std::abs(x) < 1e9 ? std::round(x * 1000) / 1000 : x; };
  return {rounded(v.x), rounded(v.y), rounded(v.z)};
}

Flat flatten(Parsed& parsed, const std::string& file, const PdbOptions& options, bool let_go, PdbReport& report) {
  Flat flat;
  size_t atoms = 0, residues = 0, chains = 0;
  for (const pdb::Model& model : parsed.structure.models) {
    chains += model.chains.size();
    for (const pdb::Chain& chain : model.chains) {
      residues += chain.residues.size();
      for (const pdb::Residue& residue : chain.residues)
        atoms += residue.atoms.size();
    }
  }
  flat.chain.reserve(chains);
  flat.residue.reserve(residues);
  flat.atom.reserve(atoms);
  std::string refused;
  constexpr size_t many = size_t{1} << 18; // atoms: their memory is worth giving back
  size_t given_back = 0;
  for (pdb::Model& model : parsed.structure.models)
    for (pdb::Chain& chain : model.chains) {
      const auto first_residue = static_cast<uint32_t>(flat.residue.size());
      for (pdb::Residue& residue : chain.residues) {
        const auto first_atom = static_cast<uint32_t>(flat.atom.size());
        for (const pdb::Atom& a : residue.atoms) {
          Atom atom;
          atom.center = {a.pos.x, a.pos.y, a.pos.z};
          atom.name = flat.names.add(a.name.empty() ? "X" : a.name.str());
          atom.element = flat.names.add(a.element.name());
          const Parsed::Values* own = parsed.pqr.empty() ? nullptr : &parsed.pqr[a.serial];
          if (own != nullptr)
            atom.charge = own->charge;
          if (own != nullptr && options.own_radii && !std::isnan(own->radius)) {
            atom.radius = own->radius;
          } else if (const auto radius = options.radii.find(residue.name.str(), a.name.str(), a.element.name())) {
            atom.radius = *radius;
          } else {
            PdbReport::Unknown& unknown = report.unknown_elements[a.element.name()];
            if (unknown.atoms++ == 0)
              unknown.first =
                  a.name.str() + " of " + residue.name.str() + " " + chain.name.str() + "/" + residue.seqid.str();
            atom.radius = options.unknown_radius;
            if (refused.empty())
              refused = "found atom " + unknown.first +
                        (a.element == gemmi::El::X ? ", of no known element"
                                                   : ", element " + std::string(a.element.name()));
          }
          flat.atom.push_back(atom);
        }
        flat.residue.push_back({&residue, first_atom, static_cast<uint32_t>(flat.atom.size())});
        if (let_go)
          std::vector<pdb::Atom>().swap(residue.atoms);
        if (let_go && flat.atom.size() - given_back > many) {
          given_back = flat.atom.size();
          give_back_memory();
        }
      }
      flat.chain.push_back({&model, &chain, first_residue, static_cast<uint32_t>(flat.residue.size())});
    }
  if (!refused.empty() && !(options.unknown_radius > 0))
    fail_input(file + ": " + refused + ", expected an element with a radius");
  return flat;
}

std::vector<Placed> place(const Flat& flat, const pdb::Structure& st, const std::string& file,
                          const std::string& assembly, PdbReport& report) {
  std::vector<Placed> placed;
  if (assembly == "none") {
    placed.reserve(flat.chain.size());
    for (uint32_t c = 0; c < flat.chain.size(); ++c)
      placed.push_back({c, 1, nullptr, nullptr});
    return placed;
  }
  const auto found = std::find_if(st.assemblies.begin(), st.assemblies.end(),
                                  [&](const gemmi::Assembly& a) { return a.name == assembly; });
  if (found == st.assemblies.end()) {
    std::string names;
    for (const gemmi::Assembly& a : st.assemblies)
      names += (names.empty() ? "" : ", ") + a.name;
    fail_input(file + ": found no assembly " + assembly + ", expected " +
               (names.empty() ? "none: the file lists no assemblies" : "one of " + names));
  }
  // Generators that use the same operator place parts of the same copy; within a generator every operator is a
  // copy.
  std::map<std::pair<std::string, Numbers>, int> copies;
  std::map<std::pair<int, size_t>, size_t> of_chain; // copy and chain: where in `placed`
  int count = 0;
  for (const gemmi::Assembly::Gen& gen : found->generators) {
    std::set<int> used;
    std::vector<std::shared_ptr<const std::vector<int64_t>>> parts;
    for (const Flat::Chain& chain : flat.chain)
      parts.push_back(std::make_shared<std::vector<int64_t>>(generated(flat, chain, gen)));
    for (const gemmi::Assembly::Operator& op : gen.operators) {
      if (!is_finite(numbers(op.transform)))
        fail_input(file + ": found operator " + op.name + " of assembly " + assembly +
                   " with a number that is not finite");
      if (!is_rotation(op.transform.mat))
        fail_input(file + ": found operator " + op.name + " of assembly " + assembly +
                   " that scales, shears or mirrors, expected a rotation and a shift");
      int& copy = copies.try_emplace({op.name, numbers(op.transform)}, 0).first->second;
      if (copy == 0 || !used.insert(copy).second)
        used.insert(copy = ++count);
      for (uint32_t c = 0; c < flat.chain.size(); ++c) {
        if (parts[c]->empty())
          continue;
        const auto [part, is_new] = of_chain.try_emplace({copy, c}, placed.size());
        if (is_new) {
          placed.push_back({c, copy, op.transform.is_identity() ? nullptr : &op.transform, parts[c]});
          continue;
        }
        std::vector<int64_t> merged;
        const std::vector<int64_t>& before = *placed[part->second].residues;
        std::set_union(before.begin(), before.end(), parts[c]->begin(), parts[c]->end(),
                       std::back_inserter(merged));
        placed[part->second].residues = std::make_shared<std::vector<int64_t>>(std::move(merged));
      }
    }
  }
  std::vector<uint8_t> used(flat.residue.size(), 0);
  for (const Placed& p : placed)
    for (const int64_t r : *p.residues)
      used[r] = 1;
  for (size_t r = 0; r < used.size(); ++r)
    if (!used[r]) {
      report.unassembled += flat.residue[r].end - flat.residue[r].begin;
      for (int64_t n = flat.residue[r].begin; n < flat.residue[r].end; ++n)
        report.dropped_charge.unassembled += std::isnan(flat.atom[n].charge) ? 0 : flat.atom[n].charge;
    }
  if (placed.empty())
    fail_input(file + ": found no atom in assembly " + assembly + ", expected at least one");
  std::stable_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) { return a.copy < b.copy; });
  report.copies = count;
  return placed;
}

std::vector<std::string> chain_names(const Flat& flat, const std::vector<Placed>& placed) {
  std::unordered_map<std::string_view, int> times, seen;
  std::unordered_set<std::string> taken;
  const bool all_once = are_unique(flat, placed);
  if (!all_once) {
    for (const Placed& p : placed)
      ++times[flat.chain[p.chain].source->name.str()];
    for (const auto& [name, n] : times)
      if (n == 1)
        taken.emplace(name);
  }
  std::vector<std::string> names;
  names.reserve(placed.size());
  for (const Placed& p : placed) {
    const std::string& name = flat.chain[p.chain].source->name;
    std::string unique = name;
    if (!all_once && times[name] > 1)
      do
        unique = name + "_" + std::to_string(++seen[name]);
      while (!taken.insert(unique).second);
    names.push_back(std::move(unique));
  }
  return names;
}

} // namespace molmesh::formats
