// mmjson.cpp — {"data_ID": {"atom_site": {"Cartn_x": [1.5, …], …}, …}} into loops.
#include "formats/pdb/mmjson.hpp"
#include "base/error.hpp"
#include "formats/pdb/atom_site.hpp"
#include "formats/pdb/parse.hpp"
#include <gemmi/json.hpp>
#include <new>

namespace molmesh::formats {
namespace {
namespace cif = gemmi::cif;

/// One category: its tags, and the values where they are used. The atoms go to `atoms`. Empty when it has no rows.
cif::Loop read_category(const std::string& name, const sajson::value& category, const std::string& file,
                        AtomSite& atoms) {
  const auto refuse = [&](const std::string& found) {
    fail_input(file + ":1: found " + found + " in category " + in_quotes(name) + ", expected arrays of one length");
  };
  if (category.get_type() != sajson::TYPE_OBJECT)
    refuse("no object");
  cif::Loop loop;
  std::vector<sajson::value> columns;
  for (size_t c = 0; c < category.get_length(); ++c) {
    columns.push_back(category.get_object_value(c));
    if (columns[c].get_type() != sajson::TYPE_ARRAY)
      refuse("no array");
    if (columns[c].get_length() != columns[0].get_length())
      refuse("arrays of different lengths");
    loop.tags.push_back("_" + name + "." + category.get_object_key(c).as_string());
  }
  const size_t width = columns.size(), rows = columns.empty() ? 0 : columns[0].get_length();
  if (rows == 0)
    return {};
  if (gemmi::to_lower("_" + name) + "." == atom_site) {
    if (atoms.begun())
      return loop;
    atoms.begin(loop.tags, 1);
    std::vector<std::string> text(width);
    std::vector<std::string_view> row(width);
    for (size_t r = 0; r < rows; ++r) {
      for (size_t c = 0; c < width; ++c)
        if (atoms.uses(c))
          row[c] = text[c] = cif::as_cif_value(columns[c].get_array_element(r));
      atoms.row(row, 1);
    }
  } else if (is_category_read("_" + name)) {
    loop.values.resize(width * rows);
    for (size_t c = 0; c < width; ++c)
      for (size_t r = 0; r < rows; ++r)
        loop.values[r * width + c] = cif::as_cif_value(columns[c].get_array_element(r));
  }
  return loop;
}

} // namespace

cif::Document read_mmjson(std::string& text, const std::string& file, AtomSite& atoms) {
  const sajson::document json =
      sajson::parse(sajson::dynamic_allocation(), sajson::mutable_string_view(text.size(), text.data()));
  if (json._internal_get_error_code() == sajson::ERROR_OUT_OF_MEMORY)
    throw std::bad_alloc();
  if (!json.is_valid())
    fail_input(file + ":" + std::to_string(json.get_error_line()) + ": found JSON with an error (" +
               json.get_error_message_as_string() + "), expected mmJSON");
  const sajson::value root = json.get_root();
  if (root.get_type() != sajson::TYPE_OBJECT)
    fail_input(file + ":1: found JSON without an object, expected mmJSON");
  cif::Document document;
  for (size_t b = 0; b < root.get_length(); ++b) {
    const std::string name = root.get_object_key(b).as_string();
    const sajson::value data = root.get_object_value(b);
    if (name.rfind("data_", 0) != 0 || data.get_type() != sajson::TYPE_OBJECT)
      fail_input(file + ":1: found " + in_quotes(name) + ", expected mmJSON with an object 'data_…'");
    cif::Block& block = document.blocks.emplace_back(name.substr(5));
    for (size_t c = 0; c < data.get_length(); ++c) {
      cif::Loop loop = read_category(data.get_object_key(c).as_string(), data.get_object_value(c), file, atoms);
      if (loop.tags.empty())
        continue;
      block.items.emplace_back(cif::LoopArg{});
      block.items.back().loop = std::move(loop);
    }
  }
  return document;
}

} // namespace molmesh::formats
