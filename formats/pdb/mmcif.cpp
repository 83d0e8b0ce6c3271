// mmcif.cpp — mmCIF and mmJSON through gemmi: the atoms row by row, of other categories only those that matter.
#include "base/error.hpp"
#include "formats/pdb/atom_site.hpp"
#include "formats/pdb/bcif.hpp"
#include "formats/pdb/mmcif_assembly.hpp"
#include "formats/pdb/mmcif_entities.hpp"
#include "formats/pdb/mmjson.hpp"
#include "formats/pdb/parse.hpp"
#include "formats/pdb/structure_builder.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <exception>
#include <gemmi/cif.hpp>
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

/// Of the category of atoms: the first loop, or else the pairs of names and values, which are one row.
struct AtomItems {
  std::vector<std::string> tags;
  std::vector<std::string_view> values; ///< of pairs
  int line = 1;
};

AtomItems atom_items(const cif::Block& block) {
  AtomItems pairs;
  for (const cif::Item& item : block.items) {
    if (!starts_with(gemmi::to_lower(tag_of(item)), atom_site.c_str()))
      continue;
    if (item.type == cif::ItemType::Loop)
      return {item.loop.tags, {}, item.line_number};
    if (pairs.tags.empty())
      pairs.line = item.line_number;
    pairs.tags.push_back(item.pair[0]);
    pairs.values.emplace_back(item.pair[1]);
  }
  return pairs;
}

/// Categories that gemmi's structure is made of.
bool is_of_structure(const std::string& tag) {
  return tag.compare(0, 8, "_entity.") == 0 || tag.compare(0, 13, "_entity_poly.") == 0 ||
         tag.compare(0, 17, "_entity_poly_seq.") == 0 || tag.compare(0, 13, "_struct_asym.") == 0;
}

/// atoms: those of the first block that has them as a loop; document: all else, and of that loop the tags.
Parsed from_document(cif::Document& document, AtomSite& atoms, Parsed& parsed, std::string_view text,
                     const std::string& file, const char* format, const std::string& assembly) {
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
  if (!atoms.begun()) {
    const AtomItems items = atom_items(*block);
    atoms.begin(items.tags, items.line);
    if (!items.values.empty())
      atoms.row(items.values, items.line);
  }
  atoms.finish();

  const std::vector<gemmi::Assembly> assemblies = read_assemblies(*block, assembly, file);
  for (const cif::Item& other : block->items)
    if (const std::string& tag = tag_of(other);
        !tag.empty() && !is_of_structure(tag) && !starts_with(gemmi::to_lower(tag), atom_site.c_str())) {
      constexpr size_t most = 1000; // the dictionary has some 600
      std::string category = tag.substr(0, tag.find('.'));
      const bool listed = parsed.passed_over.size() < most || parsed.passed_over.count(category) > 0;
      ++parsed.passed_over[listed ? std::move(category) : "others"];
    }
  // Other categories cost time and can only fail: _atom_site_anisotrop, _struct_conn, _pdbx_sifts_…
  cif::Block needed(block->name);
  for (cif::Item& other : block->items) {
    if (is_of_structure(tag_of(other))) {
      check_sequence(other, file + ":" + std::to_string(std::max(other.line_number, 1)));
      needed.items.push_back(std::move(other));
    }
  }
  try {
    read_entities(needed, parsed.structure);
  } catch (const std::bad_alloc&) { // no fault of the file
    throw;
  } catch (const std::exception& e) {
    fail_input(file + ": " + std::string(e.what()).substr(0, std::string_view(e.what()).find('\n')));
  }
  if (const int64_t restarted = part_restarted(parsed.structure); restarted > 0)
    parsed.notes.push_back("residues whose number has started again, kept apart: " + std::to_string(restarted));
  parsed.structure.assemblies = assemblies; // gemmi 0.5.7 reads no products of operators
  return std::move(parsed);
}

/// What gemmi's grammar finds: loops that are not used are counted alone, the atoms' go to AtomSite row by row.
struct Reading : cif::Document {
  Reading(AtomSite& sink, std::string_view text) : end(text.data() + text.size()), atoms(sink) {}
  const char* end; ///< of the text
  enum class Values { undecided, kept, counted, rows } values = Values::undecided;
  size_t count = 0; ///< of the loop's values that are not kept
  std::vector<std::string_view> row;
  int64_t row_line = 0;
  AtomSite& atoms;
  std::exception_ptr wrong;

  /// What is wrong with an atom is told when all is read: where the table has no value, that is the cause.
  template <class Action>
  void or_later(Action action) {
    try {
      action();
    } catch (const Error&) {
      wrong = std::current_exception();
      values = Values::counted;
    }
  }

  void decide() {
    const cif::Item& item = items_->back();
    const std::string& tag = item.loop.tags[0];
    const bool in_frame = items_ != &blocks.back().items;
    if (!in_frame && starts_with(gemmi::to_lower(tag), atom_site.c_str()) && !atoms.begun() &&
        std::none_of(blocks.begin(), blocks.end() - 1, has_atoms)) {
      values = Values::rows;
      or_later([&] { atoms.begin(item.loop.tags, item.line_number); });
    } else {
      values = !in_frame && is_category_read(std::string_view(tag).substr(0, tag.find('.'))) ? Values::kept
                                                                                             : Values::counted;
    }
  }
};

/// gemmi's check takes longer the more blocks there are, for each of them: block by block it does not.
void check_for_duplicates(cif::Document& document) {
  std::unordered_set<std::string> names;
  for (const cif::Block& block : document.blocks)
    if (!names.insert(gemmi::to_lower(block.name)).second && !block.name.empty())
      gemmi::fail(document.source + ": duplicate block name: " + block.name);
  cif::Document one;
  one.source = document.source;
  for (cif::Block& block : document.blocks) {
    one.blocks.push_back(std::move(block));
    cif::check_for_duplicates(one);
    block = std::move(one.blocks[0]);
    one.blocks.clear();
  }
}

template <class Rule>
struct Taken : cif::Action<Rule> {};

template <>
struct Taken<cif::rules::str_loop> {
  template <class Input>
  static void apply(const Input& in, Reading& out) {
    cif::Action<cif::rules::str_loop>::apply(in, out);
    out.values = Reading::Values::undecided;
    out.count = 0;
    out.row.clear();
  }
};

template <>
struct Taken<cif::rules::loop_value> {
  template <class Input>
  static void apply(const Input& in, Reading& out) {
    if (out.values == Reading::Values::undecided)
      out.decide();
    if (out.values == Reading::Values::kept) {
      // At once for as many as may come: a table that grows has twice its memory.
      if (std::vector<std::string>& all = out.items_->back().loop.values;
          all.size() == all.capacity() && all.size() >= 4096)
        all.reserve(all.size() + static_cast<size_t>(out.end - in.begin() + 1) / 2);
      return cif::Action<cif::rules::loop_value>::apply(in, out);
    }
    ++out.count;
    if (out.values != Reading::Values::rows)
      return;
    if (out.row.empty())
      out.row_line = static_cast<int64_t>(in.iterator().line);
    out.row.emplace_back(in.begin(), in.size());
    if (out.row.size() == out.items_->back().loop.tags.size()) {
      out.or_later([&] { out.atoms.row(out.row, out.row_line); });
      out.row.clear();
    }
  }
};

template <>
struct Taken<cif::rules::loop> {
  template <class Input>
  static void apply(const Input& in, Reading& out) {
    cif::Action<cif::rules::loop>::apply(in, out);
    if (out.count % out.items_->back().loop.tags.size() != 0)
      throw cif::pegtl::parse_error("Wrong number of values in the loop", in);
  }
};

} // namespace

Parsed parse_mmcif(std::string_view text, const std::string& file, const std::string& assembly) {
  Parsed parsed;
  AtomSite atoms(parsed, file, text.size());
  Reading document(atoms, text);
  document.source = file;
  try {
    cif::pegtl::memory_input<> in(text.data(), text.size(), file);
    cif::pegtl::parse<cif::rules::file, Taken, cif::Errors>(in, document);
    cif::check_for_missing_values(document);
    check_for_duplicates(document);
    if (document.wrong)
      std::rethrow_exception(document.wrong);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    fail_input(one_line(file, e.what()));
  }
  return from_document(document, atoms, parsed, text, file, "mmCIF", assembly);
}

Parsed parse_bcif(const std::string& bytes, const std::string& file, const std::string& assembly) {
  Parsed parsed;
  AtomSite atoms(parsed, file, bytes.size());
  cif::Document document = read_bcif(bytes, file, atoms);
  return from_document(document, atoms, parsed, {}, file, "BinaryCIF", assembly);
}

Parsed parse_mmjson(std::string_view text, const std::string& file, const std::string& assembly) {
  Parsed parsed;
  AtomSite atoms(parsed, file, text.size());
  cif::Document document = read_mmjson(text, file, atoms);
  return from_document(document, atoms, parsed, {}, file, "mmJSON", assembly);
}

} // namespace molmesh::formats
