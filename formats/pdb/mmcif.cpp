// mmcif.cpp — mmCIF and mmJSON through gemmi: only the categories that matter, missing columns filled in.
#include "base/error.hpp"
#include "formats/pdb/atom_site.hpp"
#include "formats/pdb/bcif.hpp"
#include "formats/pdb/chains.hpp"
#include "formats/pdb/element_name.hpp"
#include "formats/pdb/mmcif_assembly.hpp"
#include "formats/pdb/mmjson.hpp"
#include "formats/pdb/model_names.hpp"
#include "formats/pdb/parse.hpp"
#include "formats/pdb/structure_builder.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <gemmi/cif.hpp>
#include <gemmi/mmcif.hpp>
#include <limits>
#include <unordered_set>

namespace molmesh::formats {
namespace {
namespace cif = gemmi::cif;

bool starts_with(const std::string& text, const char* start) {
  return text.rfind(start, 0) == 0;
}

/// gemmi's message in one line; "FILE:12:5(…): what" loses its column.
std::string one_line(const std::string& file, std::string what) {
  what = what.substr(0, what.find('\n'));
  const size_t number = file.size() + 1;
  if (starts_with(what, (file + ":").c_str()) && number < what.size() && is_digit(what[number])) {
    size_t end = number;
    while (end < what.size() && is_digit(what[end]))
      ++end;
    const std::string line = what.substr(0, end);
    const size_t text = what.find(": ", end);
    return line + ": " + (text == std::string::npos ? what.substr(end) : what.substr(text + 2)) +
           ", expected mmCIF";
  }
  return file + ": " + (starts_with(what, (file + ": ").c_str()) ? what.substr(number + 1) : what);
}

/// And models' numbers without zeros before them.
void check_models(cif::Loop& loop, const AtomColumns& columns, const std::string& where) {
  const int column = columns.find("pdbx_PDB_model_num");
  std::unordered_set<std::string> models;
  std::string before; // nearly always the same
  for (auto i = static_cast<size_t>(std::max(column, 0)); column >= 0 && i < loop.values.size();
       i += loop.width()) {
    std::string& number = loop.values[i];
    if (number.size() > 1 && number[0] == '0' && std::all_of(number.begin(), number.end(), is_digit))
      number = model_number(number);
    if (number == before)
      continue;
    models.insert(before = number);
    if (models.size() > most_models)
      fail_input(where + ": found more than " + std::to_string(most_models) + " models, expected fewer");
  }
}

const std::string& tag_of(const cif::Item& item) {
  static const std::string none;
  if (item.type == cif::ItemType::Pair)
    return item.pair[0];
  if (item.type == cif::ItemType::Loop && !item.loop.tags.empty())
    return item.loop.tags[0];
  return none;
}

bool has_atoms(const cif::Block& block) {
  return std::any_of(block.items.begin(), block.items.end(), [](const cif::Item& item) {
    return starts_with(gemmi::to_lower(tag_of(item)), atom_site.c_str());
  });
}

/// A category that has its rows as name-value pairs has one row: gemmi reads both, here only loops remain.
cif::Item* atom_loop(cif::Block& block) {
  cif::Item loop{cif::LoopArg{}};
  loop.line_number = 0;
  for (cif::Item& item : block.items) {
    if (!starts_with(gemmi::to_lower(tag_of(item)), atom_site.c_str()))
      continue;
    if (item.type == cif::ItemType::Loop)
      return &item;
    if (loop.line_number == 0)
      loop.line_number = item.line_number;
    loop.loop.tags.push_back(item.pair[0]);
    loop.loop.values.push_back(item.pair[1]);
    item.erase();
  }
  block.items.push_back(std::move(loop));
  return &block.items.back();
}

/// Of other categories nothing is used.
bool is_read(const std::string& tag) {
  static constexpr std::array<const char*, 5> read = {"_atom_site.", "_entity.", "_entity_poly.",
                                                      "_entity_poly_seq.", "_struct_asym."};
  return std::any_of(read.begin(), read.end(), [&](const char* category) { return starts_with(tag, category); });
}

void number_rows(cif::Loop& loop, const AtomColumns& columns) {
  const auto id = static_cast<size_t>(columns.find("id"));
  for (size_t row = 0, i = id; i < loop.values.size(); ++row, i += loop.width())
    loop.values[i] = std::to_string(row);
}

/// Charges and radii of PDB2PQR's mmCIF.
void read_charges(const cif::Loop& loop, const AtomColumns& columns, Parsed& parsed) {
  const int charge = columns.find("pqr_partial_charge"), radius = columns.find("pqr_radius");
  if (charge < 0 && radius < 0)
    return;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto number = [&](size_t row, int column) {
    return column < 0 ? none : cif::as_number(loop.val(row, static_cast<size_t>(column)), none);
  };
  int64_t without = 0;
  for (size_t row = 0; row < loop.length(); ++row) {
    const Parsed::Values values{number(row, charge), number(row, radius)};
    without += radius >= 0 && !(values.radius >= 0);
    parsed.pqr.push_back({values.charge, values.radius >= 0 ? values.radius : none});
  }
  if (without > 0)
    parsed.notes.push_back("atoms without a number ≥ 0 as _atom_site.pqr_radius, which have their element's: " +
                           std::to_string(without));
}

Parsed from_document(cif::Document& document, std::string_view text, const std::string& file, const char* format,
                     const std::string& assembly) {
  Parsed parsed;
  parsed.format = format;
  std::vector<cif::Block>& blocks = document.blocks;
  const auto block = std::find_if(blocks.begin(), blocks.end(), has_atoms);
  if (block == blocks.end()) {
    const auto lines = std::max<std::ptrdiff_t>(std::count(text.begin(), text.end(), '\n'), 1);
    fail_input(file + ":" + std::to_string(lines) + ": found no _atom_site category, expected " + format +
               " with atoms");
  }
  if (const auto more = std::count_if(block + 1, blocks.end(), has_atoms); more > 0)
    parsed.notes.push_back("further data blocks with atoms, not read: " + std::to_string(more));
  cif::Item* item = atom_loop(*block);
  const std::string where = file + ":" + std::to_string(std::max(item->line_number, 1));
  cif::Loop& loop = item->loop;
  AtomColumns columns(loop);
  for (const char* name : {"Cartn_x", "Cartn_y", "Cartn_z"})
    if (columns.find(name) < 0)
      fail_input(where + ": found atoms without _atom_site." + name + ", expected coordinates");
  if (columns.find("label_atom_id") < 0 && columns.find("auth_atom_id") < 0)
    fail_input(where + ": found atoms without _atom_site.label_atom_id, expected names");
  if (loop.length() == 0)
    fail_input(where + ": found an empty _atom_site category, expected atoms");
  check_coordinates(loop, columns, text, file, item->line_number);
  check_integers(loop, columns, text, file, item->line_number);
  check_models(loop, columns, where);
  columns.complete("id", {}, "1");
  number_rows(loop, columns); // gemmi::Atom::serial is the row then
  columns.complete("type_symbol", {}, "?");
  columns.complete("label_alt_id", {}, ".");
  columns.complete("label_asym_id", {"auth_asym_id"}, "A");
  columns.complete("label_comp_id", {"auth_comp_id"}, "UNK");
  ElementGuesses guesses;
  if (const int64_t named = name_elements(loop, columns, guesses); named > 0)
    parsed.notes.push_back("atoms without an element, taken from the name: " + std::to_string(named));
  guesses.report(parsed);
  read_charges(loop, columns, parsed);
  columns.complete("occupancy", {}, "1");
  columns.complete("B_iso_or_equiv", {}, "0");
  columns.complete("auth_seq_id", {"label_seq_id"}, "1");

  const bool divided = divide_long_chains(loop, columns);

  const std::vector<gemmi::Assembly> assemblies = read_assemblies(*block, assembly, file);
  for (const cif::Item& other : block->items)
    if (const std::string& tag = tag_of(other); !tag.empty() && !is_read(tag))
      ++parsed.passed_over[tag.substr(0, tag.find('.'))];
  // Other categories cost time and can only fail: _atom_site_anisotrop, _struct_conn, _pdbx_sifts_…
  cif::Block needed(block->name);
  for (cif::Item& other : block->items) {
    const std::string& tag = tag_of(other);
    if (is_read(tag)) {
      check_sequence(other, file + ":" + std::to_string(std::max(other.line_number, 1)));
      needed.items.push_back(std::move(other));
    }
  }
  try {
    parsed.structure = gemmi::make_structure_from_block(needed);
  } catch (const std::bad_alloc&) { // no fault of the file
    throw;
  } catch (const std::exception& e) {
    fail_input(where + ": " + std::string(e.what()).substr(0, std::string_view(e.what()).find('\n')));
  }
  if (divided) {
    join_divided_chains(parsed.structure);
    gemmi::impl::fill_residue_entity_type(parsed.structure); // it looks at whole chains
  }
  if (const int64_t restarted = part_restarted(parsed.structure); restarted > 0)
    parsed.notes.push_back("residues whose number has started again, kept apart: " + std::to_string(restarted));
  parsed.structure.assemblies = assemblies; // gemmi 0.5.7 reads no products of operators
  return parsed;
}

} // namespace

Parsed parse_mmcif(std::string_view text, const std::string& file, const std::string& assembly) {
  cif::Document document;
  try {
    document = cif::read_memory(text.data(), text.size(), file.c_str());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    fail_input(one_line(file, e.what()));
  }
  return from_document(document, text, file, "mmCIF", assembly);
}

Parsed parse_bcif(const std::string& bytes, const std::string& file, const std::string& assembly) {
  cif::Document document = read_bcif(bytes, file);
  return from_document(document, {}, file, "BinaryCIF", assembly);
}

Parsed parse_mmjson(std::string& text, const std::string& file, const std::string& assembly) {
  cif::Document document;
  try {
    document = read_mmjson(text, file);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    fail_input(file + ":1: found a value that is an array or an object, expected numbers, text or null in mmJSON");
  }
  return from_document(document, {}, file, "mmJSON", assembly);
}

} // namespace molmesh::formats
