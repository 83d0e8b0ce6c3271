// vtk_xml.cpp — a scanner for the subset of XML that VTK files are written in.
#include "formats/vtu/vtk_xml.hpp"
#include "base/error.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace molmesh::formats::vtk {
namespace {

constexpr std::string_view blanks = " \t\r\n";

struct Tag {
  std::string_view name;
  std::vector<std::pair<std::string_view, std::string_view>> attributes;
  bool closing = false, empty = false;
  int64_t line = 0;
  size_t begin = 0, end = 0; ///< of "<…>" in the text

  const std::string_view* find(std::string_view key) const {
    for (const auto& [k, v] : attributes)
      if (k == key)
        return &v;
    return nullptr;
  }
};

class Parser {
public:
  Parser(const std::string& file, std::string_view text) : d_{file, text}, text_(text) {}

  Document parse() {
    Tag root;
    if (!next(root) || root.closing || root.name != "VTKFile")
      d_.refuse(root.line ? root.line : 1, "R1", "no VTKFile element, expected a VTK XML file");
    file_attributes(root);
    std::vector<std::string_view> open{root.name};
    bool appended = false;
    for (Tag tag; !open.empty();) {
      if (!next(tag))
        d_.refuse(line_, "R1",
                  "the file ends inside " + std::string(open.back()) + ", expected a whole file: make it again");
      if (tag.closing) {
        if (tag.name != open.back())
          d_.refuse(tag.line, "R1",
                    "found </" + std::string(tag.name) + ">, expected </" + std::string(open.back()) + ">");
        if (tag.name == "DataArray" && collecting_)
          close_array(tag);
        open.pop_back();
        continue;
      }
      if (tag.name == "Piece")
        begin_piece(tag);
      if (tag.name == "DataArray")
        begin_array(tag, open.back());
      if (tag.name == "AppendedData") {
        if (std::exchange(appended, true))
          d_.refuse(tag.line, "R1", "a second AppendedData");
        if (!appended_data(tag))
          continue;
      }
      if (collecting_ && tag.name != "DataArray" && array_end_ == 0)
        array_end_ = tag.begin; // VTK's InformationKey
      if (!tag.empty)
        open.push_back(tag.name);
      else if (tag.name == "DataArray" && collecting_)
        close_array(tag);
    }
    if (d_.piece.empty())
      d_.refuse(line_, "R1", "no Piece, expected one or more in UnstructuredGrid");
    locate_appended();
    return std::move(d_);
  }

private:
  /// The next start or end tag; comments, declarations and text are passed over.
  bool next(Tag& tag) {
    for (;;) {
      const size_t begin = text_.find('<', at_);
      if (begin == text_.npos)
        return advance(text_.size()), false;
      advance(begin);
      const bool comment = text_.substr(begin, 4) == "<!--";
      const bool declaration = text_.substr(begin, 2) == "<?" || text_.substr(begin, 2) == "<!";
      if (!comment && !declaration)
        break;
      const std::string_view stop = comment ? "-->" : ">";
      const size_t end = text_.find(stop, begin);
      if (end == text_.npos)
        d_.refuse(line_, "R1", "a comment or declaration that does not end");
      advance(end + stop.size());
    }
    tag = Tag{};
    tag.line = line_;
    tag.begin = at_;
    size_t p = at_ + 1;
    if (p < text_.size() && text_[p] == '/')
      tag.closing = true, ++p;
    tag.name = word(p);
    for (;;) {
      p = std::min(text_.find_first_not_of(blanks, p), text_.size());
      if (p == text_.size())
        d_.refuse(line_, "R1", "the file ends inside a tag, expected a whole file: make it again");
      if (text_[p] == '>')
        break;
      if (text_[p] == '/' && text_.substr(p, 2) == "/>") {
        tag.empty = true;
        ++p;
        break;
      }
      const std::string_view key = word(p);
      p = std::min(text_.find_first_not_of(blanks, p), text_.size());
      if (p < text_.size() && text_[p] == '=')
        p = std::min(text_.find_first_not_of(blanks, p + 1), text_.size());
      const char quote = p < text_.size() ? text_[p] : ' ';
      const size_t end = quote == '"' || quote == '\'' ? text_.find(quote, p + 1) : text_.npos;
      if (end == text_.npos)
        d_.refuse(line_, "R1", "attribute without a quoted value in <" + std::string(tag.name) + ">");
      tag.attributes.emplace_back(key, text_.substr(p + 1, end - p - 1));
      p = end + 1;
    }
    tag.end = p + 1;
    advance(tag.end);
    return true;
  }

  std::string_view word(size_t& p) const {
    const size_t begin = p;
    const auto part = [](char c) {
      return is_letter(c) || is_digit(c) || c == '_' || c == '-' || c == ':' || c == '.';
    };
    while (p < text_.size() && part(text_[p]))
      ++p;
    if (p == begin)
      d_.refuse(line_, "R1", "found a character that starts no name, expected XML");
    return text_.substr(begin, p - begin);
  }

  void advance(size_t to) {
    line_ += std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                        text_.begin() + static_cast<std::ptrdiff_t>(to), '\n');
    at_ = to;
  }

  const std::string_view& require(const Tag& tag, std::string_view key) const {
    const std::string_view* value = tag.find(key);
    if (!value)
      d_.refuse(tag.line, "R3", '<' + std::string(tag.name) + "> without " + std::string(key));
    return *value;
  }

  int64_t count(const Tag& tag, std::string_view key) const {
    std::string_view s = require(tag, key);
    s.remove_prefix(std::min(s.find_first_not_of(blanks), s.size())); // VTK pads numbers that it fills in later
    s = s.substr(0, s.find_last_not_of(blanks) + 1);
    int64_t n = -1;
    const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), n);
    if (error != std::errc{} || end != s.data() + s.size() || n < 0)
      d_.refuse(tag.line, "R3", std::string(key) + "=\"" + std::string(s.substr(0, 40)) + "\", expected a count");
    return n;
  }

  void file_attributes(const Tag& tag) {
    const auto value = [&](std::string_view key, std::string_view standard) {
      const std::string_view* v = tag.find(key);
      return std::string(v ? *v : standard);
    };
    const auto refuse = [&](const char* rule, const std::string& key, const std::string& found,
                            const std::string& expected) {
      d_.refuse(tag.line, rule, key + "=\"" + found.substr(0, 40) + "\", expected " + expected);
    };
    const std::string type = value("type", ""), version = value("version", "0.1"),
                      order = value("byte_order", "LittleEndian"), header = value("header_type", "UInt32"),
                      compressor = value("compressor", "");
    if (type != "UnstructuredGrid")
      refuse("R1", "type", type, "UnstructuredGrid");
    if (version.size() < 3 || version[0] < '0' || version[0] > '2' || version[1] != '.')
      refuse("R1", "version", version, "0.x to 2.x");
    if (order != "LittleEndian" && order != "BigEndian")
      refuse("R2", "byte_order", order, "LittleEndian or BigEndian");
    if (header != "UInt32" && header != "UInt64")
      refuse("R2", "header_type", header, "UInt32 or UInt64");
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
      refuse("R2", "compressor", compressor, "vtkZLibDataCompressor or none");
    d_.big_endian = order == "BigEndian";
    d_.header_bytes = header == "UInt64" ? 8 : 4;
    d_.zlib = !compressor.empty();
  }

  void begin_piece(const Tag& tag) {
    d_.piece.push_back({tag.line, count(tag, "NumberOfPoints"), count(tag, "NumberOfCells"), {}, {}, {}});
  }

  void begin_array(const Tag& tag, std::string_view parent) {
    if (collecting_)
      d_.refuse(tag.line, "R1", "a DataArray inside a DataArray");
    static constexpr std::array<std::string_view, 10> types{"Int8",   "UInt8", "Int16",  "UInt16",  "Int32",
                                                            "UInt32", "Int64", "UInt64", "Float32", "Float64"};
    std::vector<ArrayTag>* list = parent == "FieldData" ? &d_.field : nullptr;
    if (!d_.piece.empty()) {
      if (parent == "Points")
        list = &d_.piece.back().point;
      if (parent == "Cells")
        list = &d_.piece.back().cell;
      if (parent == "CellData")
        list = &d_.piece.back().cell_data;
    }
    if (!list)
      return; // PointData, and what later versions may add
    const std::string_view type = require(tag, "type");
    if (type == "String")
      return;
    ArrayTag a;
    const auto found = std::find(types.begin(), types.end(), type);
    if (found == types.end())
      d_.refuse(tag.line, "R3", "type=\"" + std::string(type.substr(0, 40)) + "\", expected a VTK number type");
    a.type = static_cast<ValueType>(found - types.begin());
    const std::string_view* name = tag.find("Name");
    a.name = name ? *name : "";
    a.line = tag.line;
    if (const std::string_view* n = tag.find("NumberOfComponents"); n && !n->empty())
      a.components = static_cast<int>(std::min<int64_t>(count(tag, "NumberOfComponents"), 1000));
    const std::string_view* format = tag.find("format");
    if (!format || *format == "ascii")
      a.encoding = Encoding::ascii;
    else if (*format == "binary")
      a.encoding = Encoding::inline_base64;
    else if (*format == "appended")
      a.encoding = Encoding::appended_raw;
    else
      d_.refuse(tag.line, "R3",
                "format=\"" + std::string(format->substr(0, 40)) + "\", expected ascii, binary or appended");
    if (a.encoding == Encoding::appended_raw)
      a.offset = count(tag, "offset");
    list->push_back(std::move(a));
    collecting_ = &list->back();
    array_begin_ = tag.end;
    array_end_ = 0;
  }

  void close_array(const Tag& tag) {
    const size_t end = tag.empty ? array_begin_ : array_end_ ? array_end_ : tag.begin;
    collecting_->data = text_.substr(array_begin_, end - array_begin_);
    collecting_ = nullptr;
  }

  /// Whether it has an end tag.
  bool appended_data(const Tag& tag) {
    const std::string_view* encoding = tag.find("encoding");
    raw_ = encoding && *encoding == "raw";
    if (!raw_ && (!encoding || *encoding != "base64"))
      d_.refuse(tag.line, "R3", "AppendedData without encoding raw or base64");
    const size_t mark = text_.find_first_not_of(blanks, tag.end);
    if (mark == text_.npos || text_[mark] != '_')
      d_.refuse(tag.line, "R3", "AppendedData does not start with _");
    // Raw data may hold anything, also tags: only the last end tag counts.
    size_t end = raw_ ? text_.rfind("</AppendedData") : text_.find('<', mark);
    const bool has_end = !raw_ || end != text_.npos;
    if (!has_end)
      end = text_.rfind("</VTKFile"); // CGAL 5 writes no other
    if (end == text_.npos || end <= mark)
      d_.refuse(tag.line, "R4", "AppendedData does not end, expected a whole file: make it again");
    appended_ = text_.substr(mark + 1, end - mark - 1);
    at_ = end; // lines are not counted across binary data
    return has_end;
  }

  void locate_appended() {
    const auto locate = [&](std::vector<ArrayTag>& list) {
      for (ArrayTag& a : list) {
        if (a.encoding != Encoding::appended_raw)
          continue;
        if (!raw_)
          a.encoding = Encoding::appended_base64;
        if (static_cast<size_t>(a.offset) >= appended_.size())
          d_.refuse(a.line, "R4",
                    "array '" + a.name + "' starts at byte " + std::to_string(a.offset) +
                        ", but AppendedData has " + std::to_string(appended_.size()) +
                        ", expected a whole file: make it again");
        a.data = appended_.substr(static_cast<size_t>(a.offset));
      }
    };
    locate(d_.field);
    for (Piece& p : d_.piece) {
      locate(p.point);
      locate(p.cell);
      locate(p.cell_data);
    }
  }

  Document d_;
  std::string_view text_, appended_;
  size_t at_ = 0, array_begin_ = 0, array_end_ = 0;
  int64_t line_ = 1;
  bool raw_ = true;
  ArrayTag* collecting_ = nullptr;
};

} // namespace

void Document::refuse(int64_t line, const char* rule, const std::string& what) const {
  fail_input(file + ':' + std::to_string(line) + ": " + rule + ": " + what);
}

int64_t Document::line_of(const char* place) const {
  return 1 + std::count(text.data(), place, '\n');
}

Document parse_document(const std::string& file, std::string_view text) {
  return Parser(file, text).parse();
}

} // namespace molmesh::formats::vtk
