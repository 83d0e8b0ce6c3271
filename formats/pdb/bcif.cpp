// bcif.cpp — the encodings of BinaryCIF are undone, last to first.
// D. Sehnal et al., PLoS Comput. Biol. 16 (2020) e1008247.
#include "formats/pdb/bcif.hpp"
#include "base/error.hpp"
#include "formats/pdb/atom_site.hpp"
#include "formats/pdb/gunzip.hpp"
#include "formats/pdb/msgpack.hpp"
#include "formats/pdb/parse.hpp"
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <gemmi/cifdoc.hpp>
#include <limits>
#include <stdexcept>

namespace molmesh::formats {
namespace {
namespace cif = gemmi::cif;
using msgpack::Value;

[[noreturn]] void wrong(const std::string& what) {
  throw std::runtime_error(what);
}

/// Of a category in a file of so many bytes. Each of the three coordinates of an atom takes a byte or more; and
/// as many rows as 64 MiB have room for are no harm.
size_t most_rows(size_t bytes) {
  return bytes / 3 + (size_t{64} << 20) / 256;
}

/// The numbers of a column, one after the other: its encodings are undone value by value, so that no column is
/// held.
class Numbers {
public:
  Numbers() = default;
  /// largest: how many values runs may make.
  Numbers(std::string_view bytes, const Value& encodings, size_t largest) : rest_(bytes), largest_(largest) {
    if (encodings.array.empty())
      wrong("a column without an encoding");
    for (const Value& e : encodings.array) {
      const std::string_view kind = e["kind"].text;
      const bool is_last = &e == &encodings.array.back();
      if (is_last && kind != "ByteArray")
        wrong("the last encoding " + in_quotes(kind));
      if (is_last)
        stage_.push_back({Kind::bytes, e["type"].integer});
      else if (kind == "FixedPoint")
        stage_.push_back({Kind::fixed, 0, e["factor"].real});
      else if (kind == "IntervalQuantization")
        stage_.push_back(
            {Kind::interval, 0, e["min"].real, (e["max"].real - e["min"].real) / (e["numSteps"].real - 1)});
      else if (kind == "RunLength")
        stage_.push_back({Kind::run});
      else if (kind == "Delta")
        stage_.push_back({Kind::delta, 0, e["origin"].real});
      else if (kind == "IntegerPacking")
        stage_.push_back(packing(e["byteCount"].integer, e["isUnsigned"].integer != 0));
      else
        wrong("the encoding " + in_quotes(kind));
    }
    if (rest_.size() % width() != 0)
      wrong("a column with a broken last value");
  }

  /// false behind the last.
  bool next(double& v) { return pull(0, v); }
  bool is_float() const { return stage_.back().type == 32; }

private:
  enum class Kind { bytes, fixed, interval, run, delta, packed };
  struct Stage {
    Kind kind = Kind::bytes;
    int64_t type = 0;    ///< of the bytes
    double a = 0, b = 0; ///< factor; least, step; sum so far; least and most that go on
    double value = 0;    ///< of the run
    size_t left = 0, all = 0;
  };

  static Stage packing(int64_t bytes, bool is_unsigned) {
    if (bytes != 1 && bytes != 2)
      wrong("packed integers of " + std::to_string(bytes) + " bytes");
    const double most = is_unsigned ? (bytes == 1 ? 0xFF : 0xFFFF) : (bytes == 1 ? 0x7F : 0x7FFF);
    return {Kind::packed, 0, is_unsigned ? most : -most - 1, most};
  }

  size_t width() const {
    switch (stage_.back().type) {
    case 1:
    case 4:
      return 1;
    case 2:
    case 5:
      return 2;
    case 3:
    case 6:
    case 32:
      return 4;
    case 33:
      return 8;
    default:
      wrong("a type of numbers that BinaryCIF has not: " + std::to_string(stage_.back().type));
    }
  }

  template <class T>
  double take() {
    T v{};
    std::memcpy(&v, rest_.data(), sizeof v); // the processors that molmesh knows are little-endian
    rest_.remove_prefix(sizeof v);
    return static_cast<double>(v);
  }
  double from_bytes(int64_t type) {
    switch (type) {
    case 1:
      return take<int8_t>();
    case 2:
      return take<int16_t>();
    case 3:
      return take<int32_t>();
    case 4:
      return take<uint8_t>();
    case 5:
      return take<uint16_t>();
    case 6:
      return take<uint32_t>();
    case 32:
      return take<float>();
    default:
      return take<double>();
    }
  }

  bool pull(size_t at, double& v) {
    Stage& s = stage_[at];
    if (s.kind == Kind::bytes) {
      if (rest_.empty())
        return false;
      v = from_bytes(s.type);
      return true;
    }
    if (s.kind == Kind::run) {
      while (s.left == 0) {
        double count = 0;
        if (!pull(at + 1, s.value) || !pull(at + 1, count))
          return false;
        if (!(count >= 0) || count > static_cast<double>(largest_ - s.all))
          wrong("a run longer than its column");
        s.left = static_cast<size_t>(count);
        s.all += s.left;
      }
      --s.left;
      v = s.value;
      return true;
    }
    if (!pull(at + 1, v))
      return false;
    if (s.kind == Kind::fixed)
      v /= s.a;
    else if (s.kind == Kind::interval)
      v = s.a + s.b * v;
    else if (s.kind == Kind::delta)
      v = s.a += v;
    else
      for (double part = v; part == s.a || part == s.b; v += part) // it goes on
        if (!pull(at + 1, part))
          return false;
    return true;
  }

  std::vector<Stage> stage_; ///< the first is undone last
  std::string_view rest_;
  size_t largest_ = 0;
};

std::string written(double v, bool is_float) {
  std::array<char, 40> text{};
  const auto print = [&](auto number) {
    return std::string(text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr);
  };
  if (std::abs(v) < 1e15 && v == std::floor(v))
    return print(static_cast<int64_t>(v));
  return is_float ? print(static_cast<float>(v)) : print(v);
}

/// A column's values as CIF writes them, one after the other.
class ColumnTexts {
public:
  /// Goes through it once, and checks that it has these rows.
  ColumnTexts(const Value& column, size_t rows) {
    const Value& data = column["data"];
    const Value& encodings = data["encoding"];
    if (!encodings.array.empty() && encodings.array[0]["kind"].text == "StringArray") {
      const Value& e = encodings.array[0];
      is_text_ = true;
      all_ = e["stringData"].text;
      double offset = 0;
      for (Numbers offsets(e["offsets"].text, e["offsetEncoding"], all_.size() + 2); offsets.next(offset);)
        at_.push_back(offset >= 0 && offset <= static_cast<double>(all_.size()) ? static_cast<uint32_t>(offset)
                                                                                : beyond);
      values_ = Numbers(data["data"].text, e["dataEncoding"], rows);
    } else {
      values_ = Numbers(data["data"].text, encodings, rows);
      is_float_ = values_.is_float();
    }
    size_t count = 0;
    double v = 0;
    for (Numbers values = values_; values.next(v); ++count)
      if (is_text_)
        check_text(v);
    if (count != rows)
      wrong("a column of " + std::to_string(count) + " rows in a category of " + std::to_string(rows));
    if (const Value& mask = column["mask"]; mask.kind == Value::Kind::map) {
      absent_ = Numbers(mask["data"].text, mask["encoding"], rows);
      has_mask_ = true;
      count = 0;
      for (Numbers absent = absent_; absent.next(v);)
        ++count;
      if (count != rows)
        wrong("a mask of another length than its column");
    }
  }

  /// Of the next row.
  std::string next() {
    double v = 0, absent = 0;
    values_.next(v);
    if (has_mask_)
      absent_.next(absent);
    if (absent != 0)
      return absent == 1 ? "." : "?";
    if (!is_text_)
      return written(v, is_float_);
    if (v < 0)
      return ".";
    const uint32_t begin = at_[static_cast<size_t>(v)], end = at_[static_cast<size_t>(v) + 1];
    return cif::quote(std::string(all_.substr(begin, end - begin)));
  }

private:
  static constexpr uint32_t beyond = std::numeric_limits<uint32_t>::max();

  void check_text(double i) const {
    if (i < 0)
      return;
    if (!(i + 1 < static_cast<double>(at_.size())))
      wrong("text beyond a column's");
    const uint32_t begin = at_[static_cast<size_t>(i)], end = at_[static_cast<size_t>(i) + 1];
    if (!(begin <= end && end <= all_.size()))
      wrong("text beyond a column's");
  }

  bool is_text_ = false, is_float_ = false, has_mask_ = false;
  std::string_view all_;
  std::vector<uint32_t> at_; ///< where the texts begin in it
  Numbers values_, absent_;
};

/// The categories of a file, of which runs may make more than it has bytes.
class Categories {
public:
  Categories(size_t bytes, AtomSite& atoms) : bytes_(bytes), left_(most_unpacked(bytes)), atoms_(atoms) {}

  /// Of what is not used, the first tag alone: it tells that the category is there.
  void read(const Value& category, cif::Block& block) {
    const std::string name(category["name"].text);
    const Value& columns = category["columns"];
    const int64_t rows = category["rowCount"].integer;
    if (columns.array.empty() || rows == 0)
      return;
    cif::Item item{cif::LoopArg{}};
    cif::Loop& loop = item.loop;
    const bool is_atoms = gemmi::to_lower(name) + "." == atom_site, is_read = is_atoms || is_category_read(name);
    if (is_read && (rows < 0 || static_cast<uint64_t>(rows) > most_rows(bytes_)))
      wrong("a category " + in_quotes(name) + " of " + std::to_string(rows) + " rows in a file of " +
            std::to_string(bytes_) + " bytes");
    for (const Value& column : columns.array) {
      loop.tags.push_back(name + "." + std::string(column["name"].text));
      if (!is_read)
        break;
    }
    if (is_atoms && !atoms_.begun())
      read_atoms(columns, static_cast<size_t>(rows), loop.tags);
    else if (is_read && !is_atoms)
      keep(columns, static_cast<size_t>(rows), loop.values);
    block.items.push_back(std::move(item));
  }

private:
  void count(size_t bytes) {
    if (bytes > left_)
      wrong("values that are over " + std::to_string(most_unpacked(bytes_)) +
            " bytes of text, 20 times the file's and 64 MiB");
    left_ -= bytes;
  }

  /// Row by row: no more texts are kept than those of one row.
  void read_atoms(const Value& columns, size_t rows, const std::vector<std::string>& tags) {
    atoms_.begin(tags, 0);
    std::vector<ColumnTexts> column;
    std::vector<size_t> at;
    for (size_t c = 0; c < tags.size(); ++c)
      if (atoms_.uses(c)) {
        column.emplace_back(columns.array[c], rows);
        at.push_back(c);
      }
    std::vector<std::string> text(column.size());
    std::vector<std::string_view> row(tags.size());
    for (size_t r = 0; r < rows; ++r) {
      for (size_t c = 0; c < column.size(); ++c) {
        row[at[c]] = text[c] = column[c].next();
        count(text[c].size() + 1);
      }
      atoms_.row(row, 0);
    }
  }

  void keep(const Value& columns, size_t rows, std::vector<std::string>& values) {
    const size_t width = columns.array.size();
    count(rows * width * sizeof(std::string));
    values.resize(rows * width);
    for (size_t c = 0; c < width; ++c) {
      ColumnTexts column(columns.array[c], rows);
      for (size_t r = 0; r < rows; ++r) {
        values[r * width + c] = column.next();
        count(values[r * width + c].size());
      }
    }
  }

  size_t bytes_, left_; ///< left: bytes of text that may still come
  AtomSite& atoms_;
};

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
    Categories categories(bytes.size(), atoms);
    for (const Value& block : root["dataBlocks"].array) {
      cif::Block& b = document.blocks.emplace_back(std::string(block["header"].text));
      for (const Value& category : block["categories"].array)
        categories.read(category, b);
    }
  } catch (const Error&) {
    throw;
  } catch (const std::runtime_error& e) {
    fail_input(file + ": found " + e.what() + ", expected BinaryCIF");
  }
  return document;
}

} // namespace molmesh::formats
