// bcif.cpp — the encodings of BinaryCIF are undone, last to first.
// D. Sehnal et al., PLoS Comput. Biol. 16 (2020) e1008247.
#include "formats/pdb/bcif.hpp"
#include "base/error.hpp"
#include "formats/pdb/atom_site.hpp"
#include "formats/pdb/msgpack.hpp"
#include "formats/pdb/parse.hpp"
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <gemmi/cifdoc.hpp>
#include <stdexcept>

namespace molmesh::formats {
namespace {
namespace cif = gemmi::cif;
using msgpack::Value;

/// A column on its way: numbers, or text once strings are put in.
struct Column {
  std::vector<double> number;
  bool is_float = false; ///< numbers of 32 bits: as many digits as these hold
};

[[noreturn]] void wrong(const std::string& what) {
  throw std::runtime_error(what);
}

template <class T>
std::vector<double> little_endian(std::string_view bytes) {
  if (bytes.size() % sizeof(T) != 0)
    wrong("a column with a broken last value");
  std::vector<double> out(bytes.size() / sizeof(T));
  for (size_t i = 0; i < out.size(); ++i) {
    T v{};
    std::memcpy(&v, bytes.data() + i * sizeof(T), sizeof(T)); // the processors that molmesh knows are little-endian
    out[i] = static_cast<double>(v);
  }
  return out;
}

Column from_bytes(std::string_view bytes, int64_t type) {
  switch (type) {
  case 1:
    return {little_endian<int8_t>(bytes)};
  case 2:
    return {little_endian<int16_t>(bytes)};
  case 3:
    return {little_endian<int32_t>(bytes)};
  case 4:
    return {little_endian<uint8_t>(bytes)};
  case 5:
    return {little_endian<uint16_t>(bytes)};
  case 6:
    return {little_endian<uint32_t>(bytes)};
  case 32:
    return {little_endian<float>(bytes), true};
  case 33:
    return {little_endian<double>(bytes)};
  default:
    wrong("a type of numbers that BinaryCIF has not: " + std::to_string(type));
  }
}

/// largest: of a column, which no more rows than the file has bytes can have.
std::vector<double> run_length(const std::vector<double>& pairs, size_t largest) {
  std::vector<double> out;
  for (size_t i = 0; i + 1 < pairs.size(); i += 2) {
    const double count = pairs[i + 1];
    if (!(count >= 0) || count > static_cast<double>(largest - out.size()))
      wrong("a run longer than the file has bytes");
    out.insert(out.end(), static_cast<size_t>(count), pairs[i]);
  }
  return out;
}

std::vector<double> unpacked(const std::vector<double>& packed, int64_t bytes, bool is_unsigned) {
  if (bytes != 1 && bytes != 2)
    wrong("packed integers of " + std::to_string(bytes) + " bytes");
  const double most = is_unsigned ? (bytes == 1 ? 0xFF : 0xFFFF) : (bytes == 1 ? 0x7F : 0x7FFF), least = -most - 1;
  std::vector<double> out;
  double sum = 0;
  for (const double v : packed) {
    sum += v;
    if (v == most || (!is_unsigned && v == least))
      continue; // it goes on
    out.push_back(sum);
    sum = 0;
  }
  return out;
}

Column decode(std::string_view bytes, const Value& encodings, size_t largest) {
  if (encodings.array.empty())
    wrong("a column without an encoding");
  Column column;
  for (auto e = encodings.array.rbegin(); e != encodings.array.rend(); ++e) {
    const std::string_view kind = (*e)["kind"].text;
    if (e == encodings.array.rbegin()) {
      if (kind != "ByteArray")
        wrong("the last encoding " + in_quotes(kind));
      column = from_bytes(bytes, (*e)["type"].integer);
    } else if (kind == "FixedPoint") {
      const double factor = (*e)["factor"].real;
      for (double& v : column.number)
        v /= factor;
    } else if (kind == "IntervalQuantization") {
      const double low = (*e)["min"].real, steps = (*e)["numSteps"].real;
      const double step = ((*e)["max"].real - low) / (steps - 1);
      for (double& v : column.number)
        v = low + step * v;
    } else if (kind == "RunLength") {
      column.number = run_length(column.number, largest);
    } else if (kind == "Delta") {
      double sum = (*e)["origin"].real;
      for (double& v : column.number)
        v = sum += v;
    } else if (kind == "IntegerPacking") {
      column.number = unpacked(column.number, (*e)["byteCount"].integer, (*e)["isUnsigned"].integer != 0);
    } else {
      wrong("the encoding " + in_quotes(kind));
    }
  }
  return column;
}

std::string written(double v, bool is_float) {
  std::array<char, 40> text{};
  const auto print = [&](auto number) {
    return std::string(text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr);
  };
  if (std::abs(v) < 1e15 && v == std::floor(v))
    return print(static_cast<int64_t>(v));
  return is_float ? print(static_cast<float>(v)) : print(v);
}

/// A column in as few bytes as its values allow; text(row) is the value as CIF writes it.
class ColumnTexts {
public:
  ColumnTexts(const Value& column, size_t rows) {
    const Value& data = column["data"];
    const Value& encodings = data["encoding"];
    Column values;
    if (!encodings.array.empty() && encodings.array[0]["kind"].text == "StringArray") {
      const Value& e = encodings.array[0];
      is_text_ = true;
      all_ = e["stringData"].text;
      at_ = decode(e["offsets"].text, e["offsetEncoding"], all_.size() + 2).number;
      values = decode(data["data"].text, e["dataEncoding"], rows);
      for (const double i : values.number)
        check_text(i);
    } else {
      values = decode(data["data"].text, encodings, rows);
      is_float_ = values.is_float;
    }
    if (values.number.size() != rows)
      wrong("a column of " + std::to_string(values.number.size()) + " rows in a category of " +
            std::to_string(rows));
    if (std::all_of(values.number.begin(), values.number.end(),
                    [](double v) { return std::abs(v) < 2e9 && v == std::floor(v); }))
      integer_.assign(values.number.begin(), values.number.end());
    else
      real_ = std::move(values.number);
    if (const Value& mask = column["mask"]; mask.kind == Value::Kind::map) {
      const std::vector<double> absent = decode(mask["data"].text, mask["encoding"], rows).number;
      if (absent.size() != rows)
        wrong("a mask of another length than its column");
      for (const double a : absent)
        absent_.push_back(a == 0 ? '\0' : a == 1 ? '.' : '?');
    }
  }

  std::string text(size_t row) const {
    if (!absent_.empty() && absent_[row] != '\0')
      return std::string(1, absent_[row]);
    const double v = real_.empty() ? integer_[row] : real_[row];
    if (!is_text_)
      return written(v, is_float_);
    if (v < 0)
      return ".";
    const double begin = at_[static_cast<size_t>(v)], end = at_[static_cast<size_t>(v) + 1];
    return cif::quote(std::string(all_.substr(static_cast<size_t>(begin), static_cast<size_t>(end - begin))));
  }

private:
  void check_text(double i) const {
    if (i < 0)
      return;
    if (!(i + 1 < static_cast<double>(at_.size())))
      wrong("text beyond a column's");
    const double begin = at_[static_cast<size_t>(i)], end = at_[static_cast<size_t>(i) + 1];
    if (!(begin >= 0 && begin <= end && end <= static_cast<double>(all_.size())))
      wrong("text beyond a column's");
  }

  bool is_text_ = false, is_float_ = false;
  std::string_view all_;
  std::vector<double> at_;
  std::vector<int32_t> integer_; ///< or
  std::vector<double> real_;
  std::vector<char> absent_; ///< what CIF writes for no value; empty: all are there
};

/// Row by row: no more texts are kept than those of one row.
void read_atoms(const Value& columns, size_t rows, const std::vector<std::string>& tags, AtomSite& atoms) {
  atoms.begin(tags, 0);
  std::vector<ColumnTexts> column;
  std::vector<size_t> at;
  for (size_t c = 0; c < tags.size(); ++c)
    if (atoms.uses(c)) {
      column.emplace_back(columns.array[c], rows);
      at.push_back(c);
    }
  std::vector<std::string> text(column.size());
  std::vector<std::string_view> row(tags.size());
  for (size_t r = 0; r < rows; ++r) {
    for (size_t c = 0; c < column.size(); ++c)
      row[at[c]] = text[c] = column[c].text(r);
    atoms.row(row, 0);
  }
}

void read_category(const Value& category, size_t largest, cif::Block& block, AtomSite& atoms) {
  const std::string name(category["name"].text);
  const Value& columns = category["columns"];
  const int64_t rows = category["rowCount"].integer;
  if (columns.array.empty() || rows == 0)
    return;
  if (rows < 0 || static_cast<uint64_t>(rows) > largest)
    wrong("a category " + in_quotes(name) + " of more rows than the file has bytes");
  cif::Item item{cif::LoopArg{}};
  cif::Loop& loop = item.loop;
  const size_t n = static_cast<size_t>(rows), width = columns.array.size();
  for (size_t c = 0; c < width; ++c)
    loop.tags.push_back(name + "." + std::string(columns.array[c]["name"].text));
  if (gemmi::to_lower(name) + "." == atom_site) {
    if (!atoms.begun())
      read_atoms(columns, n, loop.tags, atoms);
  } else if (is_category_read(name)) {
    loop.values.resize(n * width);
    for (size_t c = 0; c < width; ++c) {
      const ColumnTexts column(columns.array[c], n);
      for (size_t r = 0; r < n; ++r)
        loop.values[r * width + c] = column.text(r);
    }
  }
  block.items.push_back(std::move(item));
}

} // namespace

bool looks_like_bcif(std::string_view bytes) {
  if (bytes.empty())
    return false;
  const auto first = static_cast<uint8_t>(bytes[0]);
  const std::string_view head = bytes.substr(0, 256);
  return ((first >= 0x80 && first < 0x90) || first == 0xDE || first == 0xDF) && // a map
         (head.find("dataBlocks") != std::string_view::npos ||
          (head.find("encoder") != std::string_view::npos && head.find("version") != std::string_view::npos));
}

cif::Document read_bcif(const std::string& bytes, const std::string& file, AtomSite& atoms) {
  cif::Document document;
  try {
    const Value root = msgpack::parse(bytes);
    for (const Value& block : root["dataBlocks"].array) {
      cif::Block& b = document.blocks.emplace_back(std::string(block["header"].text));
      for (const Value& category : block["categories"].array)
        read_category(category, bytes.size(), b, atoms);
    }
  } catch (const Error&) {
    throw;
  } catch (const std::runtime_error& e) {
    fail_input(file + ": found " + e.what() + ", expected BinaryCIF");
  }
  return document;
}

} // namespace molmesh::formats
