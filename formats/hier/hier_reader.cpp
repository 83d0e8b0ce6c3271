// hier_reader.cpp — .hier in blocks of whole lines; every rule of HIERv1.md and HIERv2.md that a reader must check.
#include "base/error.hpp"
#include "base/shortest.hpp"
#include "formats/hier/hier.hpp"
#include "formats/hier/text.hpp"
#include "molecule/limits.hpp"
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <istream>
#include <numeric>
#include <tuple>

namespace molmesh::formats {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

/// Text for a message: shortened, with what is not printable made visible.
std::string shown(std::string_view text) {
  std::string s = "'";
  for (const char c : text.substr(0, 40)) {
    if (is_blank(c))
      s += ' ';
    else
      percent_encode(s, {&c, 1});
  }
  return s + (text.size() > 40 ? "…'" : "'");
}

/// Plain decimals of up to 15 digits, as coordinates are: digits and power of ten are exact doubles, and so their
/// quotient is correctly rounded. False for anything else.
bool short_decimal(std::string_view f, double& value) {
  static constexpr double power[] = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                     1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  const bool negative = f[0] == '-';
  if (negative)
    f.remove_prefix(1);
  if (f.empty() || f.size() > 15)
    return false;
  int64_t digits = 0;
  size_t decimals = 0, points = 0;
  for (const char c : f) {
    if (c == '.') {
      ++points;
      continue;
    }
    const unsigned digit = static_cast<unsigned char>(c) - unsigned{'0'};
    if (digit > 9)
      return false;
    digits = digits * 10 + digit;
    decimals += points;
  }
  if (points > 1 || f.size() == points)
    return false;
  value = static_cast<double>(digits) / power[decimals];
  if (negative)
    value = -value;
  return true;
}

/// The entries of short names, found without hashing a string: atoms come in a few dozen kinds.
class NameCache {
public:
  int32_t entry(std::string_view text, Names& names) {
    if (text.size() >= sizeof(uint64_t))
      return names.add(text);
    uint64_t key = text.size() << 56; // the length tells "A" from "A\0"
    std::memcpy(&key, text.data(), text.size());
    Slot& slot = slots_[(key * 0x9E3779B97F4A7C15u) >> 56];
    if (slot.key != key || slot.entry < 0)
      slot = {key, names.add(text)};
    return slot.entry;
  }

private:
  struct Slot {
    uint64_t key = 0;
    int32_t entry = -1;
  };
  std::array<Slot, 256> slots_;
};

class HierReader {
public:
  HierReader(std::istream& in, const std::string& file) : in_(in), file_(file) {}

  Hierarchy read() {
    std::string block(size_t{1} << 18, '\0');
    size_t kept = 0;
    for (;;) {
      if (kept == block.size())
        block.resize(2 * block.size());
      in_.read(block.data() + kept, static_cast<std::streamsize>(block.size() - kept));
      const auto got = static_cast<size_t>(in_.gcount());
      if (in_.bad())
        refuse("cannot read");
      const size_t size = kept + got;
      const size_t end = std::string_view(block.data(), size).rfind('\n') + 1; // 0: no whole line yet
      lines(block.data(), block.data() + end);
      kept = size - end;
      std::memmove(block.data(), block.data() + end, kept);
      if (got == 0)
        break;
    }
    ++line_;
    if (kept != 0) {
      check_text({block.data(), kept});
      refuse("R1: the last line " + shown({block.data(), kept}) + " has no end, expected a complete file");
    }
    end();
    return std::move(h_);
  }

private:
  [[noreturn]] void refuse(const std::string& what) const {
    fail_input(file_ + ":" + std::to_string(line_) + ": " + what);
  }

  void lines(const char* p, const char* end) {
    unsigned odd = 0; // any byte outside printable ASCII, tab and line feed
    for (const char* q = p; q != end; ++q) {
      const auto c = static_cast<unsigned char>(*q);
      odd |= static_cast<unsigned>(c >= 0x7F) | static_cast<unsigned>(c < 0x20 && c != '\n' && c != '\t');
    }
    while (p != end) {
      const auto* stop = static_cast<const char*>(std::memchr(p, '\n', static_cast<size_t>(end - p)));
      ++line_;
      if (odd != 0)
        check_text({p, static_cast<size_t>(stop - p)});
      at_ = p;
      stop_ = stop;
      while (stop_ != at_ && is_blank(stop_[-1]))
        --stop_;
      skip_blanks();
      if (at_ != stop_ && *at_ != '#')
        record();
      p = stop + 1;
    }
  }

  void check_text(std::string_view line) const {
    for (size_t i = 0; i < line.size();) {
      const auto c = static_cast<unsigned char>(line[i]);
      const size_t length = utf8_length(line.substr(i));
      if (length == 0)
        refuse("R1: found a byte that is not UTF-8, expected text");
      if (c == '\r')
        refuse("R1: found a carriage return, expected lines that end with a line feed alone");
      if ((c < 0x20 && c != '\t') || c == 0x7F)
        refuse("R1: found a control character, expected text");
      i += length;
    }
  }

  void skip_blanks() {
    while (at_ != stop_ && is_blank(*at_))
      ++at_;
  }

  /// The next field, empty at the end of the line.
  std::string_view field() {
    const char* begin = at_;
    while (at_ != stop_ && !is_blank(*at_))
      ++at_;
    const std::string_view f(begin, static_cast<size_t>(at_ - begin));
    skip_blanks();
    return f;
  }

  std::string_view needed(const char* what) {
    const std::string_view f = field();
    if (f.empty())
      refuse(std::string("R6: the line ends, expected ") + what);
    return f;
  }

  void expect_end(std::string_view record_shape) {
    if (at_ != stop_)
      refuse("R6: found " + shown(field()) + " more, expected " + std::string(record_shape));
  }

  std::string_view name(const char* what) {
    const std::string_view f = needed(what);
    if (f.find('%') == std::string_view::npos)
      return f;
    if (!percent_decode(f, decoded_))
      refuse("R7: found " + shown(f) + ", expected % with two hexadecimal digits");
    return decoded_;
  }

  double number(const char* what) {
    const std::string_view f = needed(what);
    double v = 0;
    if (short_decimal(f, v))
      return v;
    const auto [rest, error] = std::from_chars(f.data(), f.data() + f.size(), v);
    if (error != std::errc{} || rest != f.data() + f.size() || !std::isfinite(v))
      refuse("R8: found " + shown(f) + ", expected " + what + ", a finite decimal number");
    return v;
  }

  double coordinate(const char* what) {
    const char* begin = at_;
    const double v = number(what);
    if (!(std::abs(v) <= largest_coordinate))
      refuse("R8: found " + text_from(begin) + ", expected " + what + " of at most 1e7 Å in magnitude");
    return v;
  }

  /// Version 2 has charges without a body.
  double radius() {
    const char* begin = at_;
    const double v = number("the radius");
    if (v == 0)
      return 0;
    at_ = begin;
    return positive("the radius", largest_radius, "10000 Å");
  }

  double weight() {
    const char* begin = at_;
    const double v = number("the weight");
    if (!(v >= least_weight && v <= largest_weight))
      refuse("R9: found " + text_from(begin) + ", expected the weight, from 0.001 to 1000");
    return v;
  }

  /// most: the largest that is allowed, in words too.
  double positive(const char* what, double most, const char* in_words) {
    const char* begin = at_;
    const double v = number(what);
    if (!(v > 0))
      refuse("R9: found " + text_from(begin) + ", expected " + what + " > 0");
    if (v > most)
      refuse("R9: found " + text_from(begin) + ", expected " + what + " of at most " + in_words);
    return v;
  }

  std::string text_from(const char* begin) const {
    const char* end = at_;
    while (end != begin && is_blank(end[-1]))
      --end;
    return shown({begin, static_cast<size_t>(end - begin)});
  }

  void record() {
    const std::string_view word = field();
    if (stage_ == Stage::body) {
      if (word == "atom")
        return atom();
      if (version_ == 2 && word == "body")
        return body();
      const auto l = std::lower_bound(by_name_.begin(), by_name_.end(), word,
                                      [&](uint32_t i, std::string_view w) { return h_.level[i].name < w; });
      if (l != by_name_.end() && h_.level[*l].name == word)
        return group(*l);
      if (word == "hier" || word == "source" || word == "levels")
        refuse("R5: found a second or late record " + shown(word) + ", expected a group or an atom");
      std::string known;
      for (const Level& level : h_.level)
        known += "'" + level.name + "', ";
      refuse("R5: found " + shown(word) + ", expected " + known + "or 'atom'");
    }
    head(word);
  }

  void head(std::string_view word) {
    if (stage_ == Stage::start) {
      if (word != "hier")
        refuse("R2: found " + shown(word) + ", expected 'hier 1' or 'hier 2'");
      const std::string_view version = needed("the version, 1 or 2");
      if (version != "1" && version != "2")
        refuse("R2: found version " + shown(version) + ", expected 1 or 2: this reader knows no other");
      version_ = version[0] - '0';
      expect_end(version_ == 1 ? "'hier 1' alone" : "'hier 2' alone");
      stage_ = Stage::head;
    } else if (word == "source") {
      if (has_source_)
        refuse("R3: found a second 'source', expected 'levels'");
      h_.source.assign(at_, stop_);
      has_source_ = true;
    } else if (word == "levels") {
      levels();
      stage_ = Stage::body;
    } else {
      refuse("R4: found " + shown(word) + " before 'levels', expected 'source' or 'levels'");
    }
  }

  void levels() {
    const char* const begin = at_;
    size_t count = 0;
    for (; at_ != stop_; ++count)
      if (const std::string_view word = field(); !is_level_name(word, version_))
        refuse("R4: found level " + shown(word) +
               ", expected a word of letters, digits, _ and - that is no record's");
    at_ = begin;
    h_.level.reserve(count);
    product_.assign(count, 1);
    by_name_.resize(count);
    std::iota(by_name_.begin(), by_name_.end(), 0);
    while (at_ != stop_)
      h_.level.push_back({std::string(field()), {}});
    const auto name = [&](uint32_t l) -> const std::string& { return h_.level[l].name; };
    std::sort(by_name_.begin(), by_name_.end(),
              [&](uint32_t a, uint32_t b) { return std::tie(name(a), a) < std::tie(name(b), b); });
    auto twice = static_cast<uint32_t>(count); // the first that has come before
    for (size_t i = 1; i < count; ++i)
      if (name(by_name_[i]) == name(by_name_[i - 1]))
        twice = std::min(twice, by_name_[i]);
    if (twice < count)
      refuse("R4: found level " + shown(name(twice)) + " twice, expected distinct levels");
  }

  int64_t children(size_t l) const {
    return static_cast<int64_t>(l + 1 < h_.level.size() ? h_.level[l + 1].group.size() : h_.atom.size());
  }

  /// Closes the groups of level l and below.
  void close(size_t l) {
    for (size_t m = open_; m-- > l;) {
      Group& g = h_.level[m].group.back();
      g.end = children(m);
      if (g.end == g.begin)
        refuse("R11: " + h_.level[m].name + " " + shown(g.name) + " ends without an atom, expected one");
    }
    open_ = std::min(open_, l);
  }

  void group(size_t l) {
    close(l);
    if (l > open_)
      refuse("R10: found " + h_.level[l].name + " outside any " + h_.level[open_].name + ", expected '" +
             h_.level[open_].name + " NAME P' first");
    const std::string_view text = name("a name");
    Group g{std::string(text), 1, children(l), 0};
    g.exponent = positive("the exponent P", largest_exponent, "1000");
    if (g.exponent < least_exponent)
      refuse("R9: found an exponent P of " + shortest(g.exponent) + ", expected at least 0.0001");
    product_[l] = g.exponent * (l == 0 ? 1 : product_[l - 1]);
    if (!(product_[l] >= least_exponent && product_[l] <= largest_exponent))
      refuse("R9: found exponents of groups within each other whose product is " + shortest(product_[l]) +
             ", expected 0.0001 to 1000");
    if (version_ == 2 && at_ != stop_)
      g.weight = weight();
    expect_end(version_ == 1 ? "'LEVEL NAME P'" : "'LEVEL NAME P [WEIGHT]'");
    h_.level[l].group.push_back(std::move(g));
    open_ = l + 1;
  }

  /// Where an atom or a body may stand. A body has its innermost group for itself.
  void entry(const char* what, bool is_body) {
    if (open_ != h_.level.size())
      refuse(std::string("R10: found ") + what + " outside any " + h_.level[open_].name +
             ", expected every level open");
    if (h_.level.empty() || (h_.body.empty() && !is_body))
      return;
    const Group& g = h_.level.back().group.back();
    const auto before = static_cast<int64_t>(h_.atom.size());
    if (g.begin < before && (is_body || h_.body.back().atom == before - 1))
      refuse(std::string("R13: found ") + what + " in a " + h_.level.back().name + " with " +
             (is_body ? "something before it" : "a body") + ", expected bodies alone in theirs");
  }

  Vec3d vector(const char* what) {
    const double x = coordinate(what), y = coordinate(what);
    return {x, y, coordinate(what)};
  }

  void body() {
    using Shape = Body::Shape;
    entry("a body", true);
    Body b;
    Atom a;
    a.name = cache_.entry(name("the body's name"), h_.names);
    const std::string_view shape = needed("the shape");
    if (!shape_of(shape))
      refuse("R13: found shape " + shown(shape) + ", expected sphere, capsule, cylinder, box or slab");
    b.shape = *shape_of(shape);
    b.center = vector("a coordinate of the center");
    if (b.shape != Shape::sphere)
      b.u = vector("a coordinate of the vector U");
    if (b.shape == Shape::box)
      b.v = vector("a coordinate of the vector V");
    b.size = number(b.shape == Shape::box || b.shape == Shape::slab ? "half an edge" : "the radius");
    b.skin = number("the skin");
    expect_end("'body NAME SHAPE X Y Z [UX UY UZ [VX VY VZ]] SIZE SKIN'");
    if (const std::string fault = fault_of(b); !fault.empty())
      refuse("R13: found such a " + std::string(shape) + ", expected " + fault);
    a.center = b.center;
    a.radius = b.skin;
    b.atom = static_cast<int64_t>(h_.atom.size());
    any_body_ = true;
    h_.atom.push_back(a);
    h_.body.push_back(b);
  }

  void atom() {
    entry("an atom", false);
    Atom a;
    a.name = cache_.entry(name("the atom's name"), h_.names);
    a.element = cache_.entry(name("the element"), h_.names);
    a.center.x = coordinate("x");
    a.center.y = coordinate("y");
    a.center.z = coordinate("z");
    a.radius = version_ == 1 ? positive("the radius", largest_radius, "10000 Å") : radius();
    any_body_ |= a.radius > 0;
    if (at_ != stop_)
      a.charge = number("the charge");
    expect_end("'atom NAME ELEMENT X Y Z RADIUS [CHARGE]'");
    h_.atom.push_back(a);
  }

  void end() {
    if (stage_ == Stage::start)
      refuse("R2: the file is empty, expected 'hier 1' or 'hier 2'");
    if (stage_ == Stage::head)
      refuse("R4: the file ends, expected 'levels'");
    close(0);
    if (h_.atom.empty())
      refuse("R12: the file ends, expected at least one atom");
    if (!any_body_)
      refuse("R12: the file ends, expected at least one atom of a radius > 0, or a body");
  }

  enum class Stage { start, head, body };
  std::istream& in_;
  const std::string& file_;
  Hierarchy h_;
  std::vector<uint32_t> by_name_; ///< levels, ascending
  NameCache cache_;
  std::string decoded_;
  Stage stage_ = Stage::start;
  int version_ = 1;
  bool any_body_ = false;
  bool has_source_ = false;
  std::vector<double> product_; ///< [level]: of the exponents of its open group and those around it
  size_t open_ = 0;             ///< levels [0, open_) have an open group
  int64_t line_ = 0;
  const char *at_ = nullptr, *stop_ = nullptr;
};

} // namespace

Hierarchy read_hier(std::istream& in, const std::string& file) {
  return HierReader(in, file).read();
}

} // namespace molmesh::formats
