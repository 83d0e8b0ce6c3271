// mmjson.cpp — {"data_ID": {"atom_site": {"Cartn_x": [1.5, …], …}, …}} into loops; the atoms' columns side by side.
#include "formats/pdb/mmjson.hpp"
#include "base/error.hpp"
#include "formats/pdb/atom_site.hpp"
#include "formats/pdb/parse.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <vector>

namespace molmesh::formats {
namespace {
namespace cif = gemmi::cif;

/// Goes through JSON without keeping it: no more memory is taken than one byte a level.
class Json {
public:
  Json(std::string_view text, const std::string& file, size_t at = 0) : text_(text), file_(&file), at_(at) {}

  [[noreturn]] void wrong(const std::string& what) const {
    const auto lines = std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
    fail_input(*file_ + ":" + std::to_string(lines + 1) + ": found JSON with an error (" + what +
               "), expected mmJSON");
  }

  size_t at() const { return at_; }
  /// The first character of what comes next; NUL at the end.
  char next() {
    at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool has(char c) {
    if (next() != c)
      return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!has(c))
      wrong("no '" + std::string(1, c) + "'");
  }

  std::string text() {
    std::string s;
    expect('"');
    for (;;) {
      const size_t end = std::min(text_.find_first_of("\"\\", at_), text_.size());
      const std::string_view plain = text_.substr(at_, end - at_);
      if (std::any_of(plain.begin(), plain.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
        wrong("a control character in a text");
      s += plain;
      at_ = end;
      if (end == text_.size())
        wrong("a text without its end");
      if (text_[at_++] == '"')
        return s;
      escape(s);
    }
  }

  /// A number, true, false or null as it stands there.
  std::string_view word() {
    next();
    const size_t end = std::min(text_.find_first_of(" \t\r\n,]}:[{\"", at_), text_.size());
    const std::string_view w = text_.substr(at_, end - at_);
    if (w != "true" && w != "false" && w != "null" && !is_number(w))
      wrong("no value");
    at_ = end;
    return w;
  }

  /// Calls take() for each element of an array; it leaves this behind the element.
  template <class Take>
  void array(Take take) {
    expect('[');
    if (has(']'))
      return;
    do
      take();
    while (has(','));
    expect(']');
  }
  /// Calls take(key) for each member of an object; it leaves this behind the value.
  template <class Take>
  void object(Take take) {
    expect('{');
    if (has('}'))
      return;
    do {
      const std::string key = text();
      expect(':');
      take(key);
    } while (has(','));
    expect('}');
  }

  /// Any value, however deep.
  void skip() {
    std::string open;
    for (;;) {
      if (has('[') || has('{')) {
        const char c = text_[at_ - 1];
        if (!has(c == '[' ? ']' : '}')) {
          open += c;
          if (c == '{')
            skip_key();
          continue;
        }
      } else if (next() == '"') {
        text();
      } else {
        word();
      }
      while (!open.empty() && !has(',')) {
        expect(open.back() == '[' ? ']' : '}');
        open.pop_back();
      }
      if (open.empty())
        return;
      if (open.back() == '{')
        skip_key();
    }
  }

private:
  void skip_key() {
    text();
    expect(':');
  }

  /// JSON's: -1.5e+3, without a leading zero or plus.
  static bool is_number(std::string_view w) {
    const auto digits = [&] {
      const size_t n = std::min(w.find_first_not_of("0123456789"), w.size());
      w.remove_prefix(n);
      return n;
    };
    if (!w.empty() && w[0] == '-')
      w.remove_prefix(1);
    if (w.size() > 1 && w[0] == '0' && is_digit(w[1]))
      return false;
    if (digits() == 0)
      return false;
    if (!w.empty() && w[0] == '.') {
      w.remove_prefix(1);
      if (digits() == 0)
        return false;
    }
    if (!w.empty() && (w[0] == 'e' || w[0] == 'E')) {
      w.remove_prefix(w.size() > 1 && (w[1] == '-' || w[1] == '+') ? 2 : 1);
      if (digits() == 0)
        return false;
    }
    return w.empty();
  }

  uint32_t hexadecimal() {
    uint32_t code = 0;
    for (int i = 0; i < 4; ++i, ++at_) {
      const char c = at_ < text_.size() ? text_[at_] : '\0';
      const char letter = static_cast<char>(c | 0x20);
      if (!is_digit(c) && !(letter >= 'a' && letter <= 'f'))
        wrong("a character's number that is none");
      code = code * 16 + static_cast<uint32_t>(is_digit(c) ? c - '0' : letter - 'a' + 10);
    }
    return code;
  }

  /// Behind the backslash.
  void escape(std::string& s) {
    static constexpr std::string_view names = "\"\\/bfnrt", meant = "\"\\/\b\f\n\r\t";
    const char c = at_ < text_.size() ? text_[at_++] : '\0';
    if (const size_t known = names.find(c); known != std::string_view::npos) {
      s += meant[known];
      return;
    }
    if (c != 'u')
      wrong("a backslash before no character that has one");
    uint32_t code = hexadecimal();
    if (code >= 0xD800 && code < 0xDC00) { // the first of two
      if (text_.substr(at_, 2) != "\\u")
        wrong("half a character");
      at_ += 2;
      const uint32_t low = hexadecimal();
      if (low < 0xDC00 || low > 0xDFFF)
        wrong("half a character");
      code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
    } else if (code >= 0xDC00 && code < 0xE000) {
      wrong("half a character");
    }
    const auto byte = [&](uint32_t b) { s += static_cast<char>(b); };
    if (code < 0x80) {
      byte(code);
    } else if (code < 0x800) {
      byte(0xC0 | code >> 6);
      byte(0x80 | (code & 0x3F));
    } else if (code < 0x10000) {
      byte(0xE0 | code >> 12);
      byte(0x80 | (code >> 6 & 0x3F));
      byte(0x80 | (code & 0x3F));
    } else {
      byte(0xF0 | code >> 18);
      byte(0x80 | (code >> 12 & 0x3F));
      byte(0x80 | (code >> 6 & 0x3F));
      byte(0x80 | (code & 0x3F));
    }
  }

  std::string_view text_;
  const std::string* file_;
  size_t at_;
};

/// Of a category that is used; dictionaries have some 30.
constexpr size_t most_columns = 1000;

/// A column, gone through from its first element on.
struct Column {
  Json json;
  /// The next value as CIF writes it.
  std::string value(const std::string& file) {
    json.has(','); // of the element before
    const char c = json.next();
    if (c == '"')
      return cif::quote(json.text());
    const std::string_view w = c == '[' || c == '{' ? "true" : json.word();
    if (w == "true")
      fail_input(file + ":1: found a value that is an array, an object or true, expected numbers, text or null in "
                        "mmJSON");
    return w == "null" ? "?" : w == "false" ? "." : std::string(w);
  }
};

/// One category: its tags, and the values where they are used. The atoms go to `atoms`. Empty when it has no rows.
cif::Loop read_category(Json& json, std::string_view text, const std::string& name, const std::string& file,
                        AtomSite& atoms) {
  const auto refuse = [&](const std::string& found) {
    fail_input(file + ":1: found " + found + " in category " + in_quotes(name) + ", expected arrays of one length");
  };
  if (json.next() != '{')
    refuse("no object");
  cif::Loop loop;
  std::vector<Column> columns;
  size_t rows = 0, width = 0;
  const bool is_atoms = gemmi::to_lower("_" + name) + "." == atom_site,
             is_read = is_atoms || is_category_read("_" + name);
  json.object([&](const std::string& key) {
    if (json.next() != '[')
      refuse("no array");
    if (is_read || width == 0) { // of what is not used, the first tag alone: it tells that the category is there
      loop.tags.push_back("_" + name + "." + key);
      columns.emplace_back(Column{Json(text, file, json.at() + 1)});
    }
    size_t its_rows = 0;
    json.array([&] {
      json.skip();
      ++its_rows;
    });
    if (width++ == 0)
      rows = its_rows;
    if (its_rows != rows)
      refuse("arrays of different lengths");
    if (is_read && width > most_columns)
      refuse("more than " + std::to_string(most_columns) + " arrays");
  });
  if (rows == 0)
    return {};
  if (is_atoms) {
    if (atoms.begun())
      return loop;
    atoms.begin(loop.tags, 1);
    std::vector<size_t> used;
    for (size_t c = 0; c < width; ++c)
      if (atoms.uses(c))
        used.push_back(c);
    std::vector<std::string> value(used.size());
    std::vector<std::string_view> row(width);
    for (size_t r = 0; r < rows; ++r) {
      for (size_t u = 0; u < used.size(); ++u)
        row[used[u]] = value[u] = columns[used[u]].value(file);
      atoms.row(row, 1);
    }
  } else if (is_read) {
    loop.values.reserve(width * rows);
    for (size_t r = 0; r < rows; ++r)
      for (Column& column : columns)
        loop.values.push_back(column.value(file));
  }
  return loop;
}

} // namespace

cif::Document read_mmjson(std::string_view text, const std::string& file, AtomSite& atoms) {
  Json json(text, file);
  if (json.next() != '{')
    fail_input(file + ":1: found JSON without an object, expected mmJSON");
  cif::Document document;
  json.object([&](const std::string& name) {
    if (name.rfind("data_", 0) != 0 || json.next() != '{')
      fail_input(file + ":1: found " + in_quotes(name) + ", expected mmJSON with an object 'data_…'");
    cif::Block& block = document.blocks.emplace_back(name.substr(5));
    json.object([&](const std::string& category) {
      cif::Loop loop = read_category(json, text, category, file, atoms);
      if (loop.tags.empty())
        return;
      block.items.emplace_back(cif::LoopArg{});
      block.items.back().loop = std::move(loop);
    });
  });
  if (json.next() != '\0' || json.at() != text.size())
    json.wrong("something behind the object");
  return document;
}

} // namespace molmesh::formats
