// mmjson.cpp — {"data_ID": {"atom_site": {"Cartn_x": [1.5, …], …}, …}} into loops.
#include "formats/pdb/mmjson.hpp"
#include "base/error.hpp"
#include "formats/pdb/parse.hpp"
#include <gemmi/json.hpp>
#include <new>

namespace molmesh::formats {
namespace {
namespace cif = gemmi::cif;

/// One category as a loop; empty when it has no rows.
cif::Loop read_category(const std::string& name, const sajson::value& category, const std::string& file) {
  const auto refuse = [&](const std::string& found) {
    fail_input(file + ":1: found " + found + " in category " + in_quotes(name) + ", expected arrays of one length");
  };
  if (category.get_type() != sajson::TYPE_OBJECT)
    refuse("no object");
  cif::Loop loop;
  const size_t columns = category.get_length();
  for (size_t c = 0; c < columns; ++c) {
    const sajson::value column = category.get_object_value(c);
    if (column.get_type() != sajson::TYPE_ARRAY)
      refuse("no array");
    const size_t rows = column.get_length();
    if (c == 0)
      loop.values.resize(columns * rows);
    if (columns * rows != loop.values.size())
      refuse("arrays of different lengths");
    loop.tags.push_back("_" + name + "." + category.get_object_key(c).as_string());
    for (size_t r = 0; r < rows; ++r)
      loop.values[r * columns + c] = cif::as_cif_value(column.get_array_element(r));
  }
  return loop;
}

} // namespace

cif::Document read_mmjson(std::string& text, const std::string& file) {
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
      cif::Loop loop = read_category(data.get_object_key(c).as_string(), data.get_object_value(c), file);
      if (loop.values.empty())
        continue;
      block.items.emplace_back(cif::LoopArg{});
      block.items.back().loop = std::move(loop);
    }
  }
  return document;
}

} // namespace molmesh::formats
