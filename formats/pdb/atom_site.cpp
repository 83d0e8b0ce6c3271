// atom_site.cpp — what would make gemmi throw without saying where, or overflow, is refused here, by line.
#include "formats/pdb/atom_site.hpp"
#include "base/error.hpp"
#include "formats/pdb/model_names.hpp"
#include "molecule/limits.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <cmath>
#include <gemmi/mmcif.hpp>
#include <gemmi/numb.hpp>
#include <limits>

namespace molmesh::formats {
namespace {
namespace cif = gemmi::cif;

/// gemmi's integers overflow unnoticed: nine digits at most.
bool is_integer(std::string_view value) {
  if (!value.empty() && (value[0] == '-' || value[0] == '+'))
    value.remove_prefix(1);
  return !value.empty() && value.size() <= 9 && value.find_first_not_of("0123456789") == std::string_view::npos;
}

} // namespace

bool is_category_read(std::string_view name) {
  static constexpr std::array<std::string_view, 7> read = {"_entity",
                                                           "_entity_poly",
                                                           "_entity_poly_seq",
                                                           "_struct_asym",
                                                           "_pdbx_struct_assembly",
                                                           "_pdbx_struct_assembly_gen",
                                                           "_pdbx_struct_oper_list"};
  return std::find(read.begin(), read.end(), name) != read.end();
}

std::string AtomSite::at(int64_t line) const {
  return file_ + ":" + std::to_string(std::max<int64_t>(line, line_));
}

bool AtomSite::says(Column c) const {
  return has(c) && !cif::is_null(value_[c]);
}

void AtomSite::complete(Column c, Column like, const char* value) {
  if (has(c))
    return;
  at_[c] = at_[like];
  value_[c] = value;
}

void AtomSite::begin(const std::vector<std::string>& tags, int64_t line) {
  begun_ = true;
  line_ = std::max<int64_t>(line, 1);
  at_.fill(-1);
  for (size_t t = tags.size(); t-- > 0;) // the first of equal ones
    for (size_t c = 0; c < columns; ++c)
      if (gemmi::to_lower(tags[t]) == atom_site + names[c])
        at_[c] = static_cast<int>(t);
  for (const auto& [c, name] : {std::pair{x, "Cartn_x"}, {y, "Cartn_y"}, {z, "Cartn_z"}})
    if (!has(c))
      fail_input(at(0) + ": found atoms without _atom_site." + name + ", expected coordinates");
  if (!has(label_atom) && !has(auth_atom))
    fail_input(at(0) + ": found atoms without _atom_site.label_atom_id, expected names");
  used_.assign(tags.size(), 0);
  for (const int t : at_)
    if (t >= 0)
      used_[static_cast<size_t>(t)] = 1;
  chain_column_ = has(auth_chain) ? auth_chain : label_chain;
  residue_column_ = has(auth_residue) ? auth_residue : label_residue;
  atom_column_ = has(auth_atom) ? auth_atom : label_atom;
  complete(symbol, symbol, "?");
  complete(alternative, alternative, ".");
  complete(label_chain, auth_chain, "A");
  complete(label_residue, auth_residue, "UNK");
  complete(label_atom, auth_atom, "");
  complete(occupancy, occupancy, "1");
  complete(b_factor, b_factor, "0");
  complete(number, label_number, "1");
}

void AtomSite::check(int64_t line) {
  const auto refuse = [&](Column c, const std::string& expected) {
    // The format's own spelling.
    const char* const name = c == x ? "Cartn_x" : c == y ? "Cartn_y" : c == z ? "Cartn_z" : names[c];
    fail_input(at(line) + ": found " + in_quotes(value_[c]) + " as " + name + ", expected " + expected);
  };
  for (const Column c : {x, y, z})
    if (!(std::abs(cif::as_number(value_[c])) <= largest_coordinate))
      refuse(c, "a coordinate (Å)");
  for (const Column c : {number, label_number}) {
    if (!says(c))
      continue;
    std::string_view digits = value_[c];
    if (c == number && digits.size() > 1 && digits.back() > '9')
      digits.remove_suffix(1);
    if (!is_integer(digits))
      refuse(c, "an integer");
  }
}

void AtomSite::check_memory(int64_t line) const {
  constexpr size_t atom = 90, residue = 110, chain = 140, name = 50; // pdb2hier's bytes for each
  const size_t takes = atom * static_cast<size_t>(rows_) + residue * residues_.size() + chain * chain_count_ +
                       name * parsed_.structure.labels.size();
  if (takes > most_memory_)
    fail_input(at(line) + ": found " + std::to_string(rows_) + " atoms of " + std::to_string(residues_.size()) +
               " residues and " + std::to_string(chain_count_) + " chains, which take over " +
               std::to_string(most_memory_) + " bytes, expected at most 20 times the file and 64 MiB");
}

gemmi::Element AtomSite::element() {
  std::string& text = value_[symbol];
  if (const auto end = std::find_if_not(text.begin(), text.end(), is_letter); end != text.begin())
    text.erase(end, text.end()); // "O1-": a charge behind it
  if (!cif::is_null(text))
    return gemmi::Element(cif::as_string(text));
  const std::string name = cif::as_string(value_[label_atom]), of = cif::as_string(value_[label_residue]);
  const gemmi::Element named_as = named_element(name, of);
  guesses_.add(name, of, named_as);
  ++named_;
  return named_as;
}

void AtomSite::open_model() {
  std::string& n = value_[model];
  if (n.size() > 1 && n[0] == '0' && std::all_of(n.begin(), n.end(), is_digit))
    n = model_number(n);
  const std::string& name = has(model) ? n : "1";
  if (rows_ > 0 && name == model_)
    return;
  chain_open_ = false;
  model_ = name;
  const auto [known, is_new] = model_of_name_.try_emplace(cif::as_string(name), models_.size());
  if (is_new) {
    if (models_.size() == most_models)
      fail_input(at(0) + ": found more than " + std::to_string(most_models) + " models, expected fewer");
    models_.emplace_back(known->first);
    chains_.emplace_back();
  }
  model_index_ = known->second;
}

void AtomSite::open_residue() {
  const std::array<const std::string*, 3> now = {&value_[residue_column_], &value_[number], &value_[insertion]};
  bool same = residue_open_;
  for (size_t i = 0; i < now.size(); ++i)
    if (residue_[i] != *now[i]) {
      residue_[i] = *now[i];
      same = false;
    }
  if (same)
    return;
  const gemmi::ResidueId theirs = gemmi::impl::make_resid(cif::as_string(residue_[0]), cif::as_string(residue_[1]),
                                                          has(insertion) ? &residue_[2] : nullptr);
  const pdb::ResidueId id{theirs.seqid, {}, label(theirs.name)};
  if (residue_open_ && residues_[residue_index_].matches(id))
    return;
  close_residue();
  residue_open_ = true;
  residue_index_ = index_of(id);
  if (residue_index_ < residues_.size())
    return;
  pdb::Residue& fresh = residues_.emplace_back(id);
  fresh.subchain = label(cif::as_string(value_[label_chain]));
  if (says(entity))
    fresh.entity_id = label(cif::as_string(value_[entity]));
  if (says(group))
    for (size_t i = 0; i < 2 && i <= value_[group].size(); ++i) // the first may be a quote
      if (const char c = gemmi::alpha_up(value_[group][i]); c == 'A' || c == 'H' || c == '\0')
        fresh.het_flag = c;
}

/// Of the open run; a new one's is the next.
size_t AtomSite::index_of(const pdb::ResidueId& id) {
  const size_t begin = runs_.back().begin;
  return begin + known_.find_or_add(
                     static_cast<uint32_t>(residues_.size() - begin), pdb::hash(id),
                     [&](uint32_t r) { return residues_[begin + r].matches(id); },
                     [&](uint32_t r) { return pdb::hash(residues_[begin + r]); });
}

void AtomSite::close_residue() {
  if (!atoms_.empty())
    atoms_.move_to(residues_[residue_index_].atoms);
}

void AtomSite::open_chain() {
  close_residue();
  chain_open_ = true;
  residue_open_ = false;
  known_.clear();
  Chains& chains = chains_[model_index_];
  const auto next = static_cast<uint32_t>(chains.name.size());
  const std::hash<std::string> hash;
  const uint32_t chain = chains.index.find_or_add(
      next, hash(chain_), [&](uint32_t c) { return chains.name[c] == chain_; },
      [&](uint32_t c) { return hash(chains.name[c]); });
  if (chain == next) {
    chains.name.emplace_back(label(chain_));
    ++chain_count_;
  }
  runs_.emplace_back(Run{static_cast<uint32_t>(model_index_), chain, static_cast<uint32_t>(residues_.size())});
}

/// Into their chains, chunk by chunk.
void AtomSite::place_residues() {
  close_residue();
  known_.clear();
  for (size_t m = 0; m < models_.size(); ++m) {
    chains_[m].index.clear();
    models_[m].chains.reserve(chains_[m].name.size());
    chains_[m].name.move_each([&](size_t, pdb::Label name) { models_[m].chains.emplace_back(name); });
  }
  const auto end_of = [&](size_t run) {
    return run + 1 < runs_.size() ? size_t{runs_[run + 1].begin} : residues_.size();
  };
  std::vector<std::vector<uint32_t>> count(models_.size()); // of residues, by chain
  for (size_t m = 0; m < models_.size(); ++m)
    count[m].resize(models_[m].chains.size());
  for (size_t run = 0; run < runs_.size(); ++run)
    count[runs_[run].model][runs_[run].chain] += static_cast<uint32_t>(end_of(run) - runs_[run].begin);
  size_t run = 0;
  residues_.move_each([&](size_t r, pdb::Residue&& residue) {
    while (r == end_of(run))
      ++run;
    pdb::Chain& chain = models_[runs_[run].model].chains[runs_[run].chain];
    if (chain.residues.empty())
      chain.residues.reserve(count[runs_[run].model][runs_[run].chain]);
    residue.begins_run = r == runs_[run].begin;
    chain.residues.push_back(std::move(residue));
  });
}

void AtomSite::row(const std::vector<std::string_view>& values, int64_t line) {
  for (size_t c = 0; c < columns; ++c)
    if (at_[c] >= 0)
      value_[c].assign(values[static_cast<size_t>(at_[c])]);
  check(line);
  try {
    open_model();
    if (!chain_open_ || value_[chain_column_] != chain_name_) {
      chain_name_ = value_[chain_column_];
      if (std::string name = cif::as_string(chain_name_); !chain_open_ || name != chain_) {
        chain_ = std::move(name);
        open_chain();
      }
    }
    open_residue();
    pdb::Atom& atom = atoms_.emplace_back();
    atom.name = label(cif::as_string(value_[atom_column_]));
    atom.altloc = cif::as_char(value_[alternative], '\0');
    atom.element = element();
    atom.serial = static_cast<int32_t>(rows_);
    atom.pos = {cif::as_number(value_[x]), cif::as_number(value_[y]), cif::as_number(value_[z])};
    atom.occ = static_cast<float>(cif::as_number(value_[occupancy], 1.0));
    atom.b_iso = static_cast<float>(cif::as_number(value_[b_factor], 50.0));
    if (has(deuterium) && atom.element == gemmi::El::H)
      mix_deuterium(cif::as_number(value_[deuterium]));
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) { // no fault of the file
    throw;
  } catch (const std::exception& e) {
    fail_input(at(line) + ": " + std::string(e.what()).substr(0, std::string_view(e.what()).find('\n')));
  }
  ++rows_;
  check_memory(line);
  if (!has(charge) && !has(radius))
    return;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const double q = has(charge) ? cif::as_number(value_[charge], none) : none,
               r = has(radius) ? cif::as_number(value_[radius], none) : none;
  without_radius_ += has(radius) && !(r >= 0);
  large_ += r > believed_radius;
  parsed_.pqr.push_back({q, r >= 0 ? r : none});
}

/// Of the last atom, a hydrogen: as gemmi::impl::apply_hd_mixture(), a deuterium, or both as alternatives.
void AtomSite::mix_deuterium(double hydrogen) {
  pdb::Atom& atom = atoms_.back();
  if (hydrogen <= 0 || hydrogen >= 1) {
    atom.element = hydrogen <= 0 ? gemmi::El::D : gemmi::El::H;
    return;
  }
  const int alternative_of = atom.altloc == '\0' ? 0 : atom.altloc - 'A';
  if (alternative_of < 0 || alternative_of >= 3)
    return;
  pdb::Atom other = atom;
  other.element = gemmi::El::D;
  other.occ = static_cast<float>(static_cast<double>(atom.occ) * (1 - hydrogen));
  other.altloc = static_cast<char>('D' + alternative_of);
  atom.occ = static_cast<float>(static_cast<double>(atom.occ) * hydrogen);
  atom.altloc = static_cast<char>('A' + alternative_of);
  atoms_.emplace_back(other);
}

void AtomSite::finish() {
  if (rows_ == 0)
    fail_input(at(0) + ": found an empty _atom_site category, expected atoms");
  place_residues();
  parsed_.structure.models = std::move(models_);
  if (named_ > 0)
    parsed_.notes.push_back("atoms without an element, taken from the name: " + std::to_string(named_));
  guesses_.report(parsed_);
  if (without_radius_ > 0)
    parsed_.notes.push_back("atoms without a number ≥ 0 as _atom_site.pqr_radius, which have their element's: " +
                            std::to_string(without_radius_));
  if (large_ > 0)
    parsed_.notes.push_back(note_of_large_radii(large_));
}

void check_sequence(const cif::Item& item, const std::string& where) {
  const std::string tag = "_entity_poly_seq.num";
  const auto check = [&](const std::string& value) {
    if (!cif::is_null(value) && !is_integer(value))
      fail_input(where + ": found " + in_quotes(value) + " as " + tag + ", expected an integer");
  };
  if (item.type == cif::ItemType::Pair && item.pair[0] == tag)
    check(item.pair[1]);
  if (item.type == cif::ItemType::Loop)
    if (const int column = item.loop.find_tag(tag); column >= 0)
      for (size_t i = static_cast<size_t>(column); i < item.loop.values.size(); i += item.loop.width())
        check(item.loop.values[i]);
}

} // namespace molmesh::formats
