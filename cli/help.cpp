// help.cpp — names and units on the left; meaning, range and default on the right.
#include "cli/pages.hpp"
#include "cli/text.hpp"
#include <algorithm>
#include <sstream>

namespace molmesh::cli {
namespace {

constexpr size_t left_width = 26, right_width = 70, page_width = 100;

std::string left(const Option& o) {
  if (o.argument)
    return "  " + o.name;
  const std::string text = (o.letter.empty() ? "      --" : "  -" + o.letter + ", --") + o.name;
  return o.flag() ? text : text + ' ' + o.shown_unit();
}

void print(std::ostream& out, const Option& o) {
  const std::string name = left(o), notes = notes_of(o);
  out << name;
  bool fits = columns(name) + 2 <= left_width;
  size_t gap = fits ? left_width - columns(name) : 0;
  for (const std::string& line : wrapped(notes.empty() ? o.meaning : o.meaning + " (" + notes + ")", right_width)) {
    if (!fits)
      out << '\n';
    out << std::string(fits ? gap : left_width, ' ') << line;
    fits = false;
  }
  out << '\n';
}

} // namespace

std::vector<OptionGroup> grouped(const Table& table) {
  std::vector<OptionGroup> groups;
  OptionGroup common{"common options", {}};
  for (const Option& o : table.options) {
    if (o.argument)
      continue;
    if (o.group.empty()) {
      common.options.push_back(&o);
      continue;
    }
    const auto same =
        std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.heading == o.group; });
    if (same != groups.end())
      same->options.push_back(&o);
    else
      groups.push_back({o.group, {&o}});
  }
  groups.push_back(std::move(common));
  return groups;
}

std::string notes_of(const Option& o) {
  std::string notes = o.shown_range();
  const auto add = [&](const std::string& note) { notes += (notes.empty() ? "" : "; ") + note; };
  if (o.several())
    add("repeatable");
  if (o.must_be_given)
    add("required");
  if (!o.flag() && !o.default_text.empty())
    add("default " + o.default_text);
  return notes;
}

std::string help(const Table& table) {
  std::ostringstream out;
  out << table.program << ": " << table.purpose << "\n\nusage: " << table.program << " [OPTIONS]";
  for (const Option& o : table.options)
    if (o.argument)
      out << (o.must_be_given ? " " + o.name : " [" + o.name + ']');
  out << "\n\n";
  for (const Option& o : table.options)
    if (o.argument)
      print(out, o);
  for (const OptionGroup& group : grouped(table)) {
    out << '\n' << group.heading << ":\n";
    for (const Option* o : group.options)
      print(out, *o);
  }
  if (!table.page.examples.empty())
    out << "\nexamples:\n";
  for (const Page::Example& e : table.page.examples)
    out << "  " << e.command << '\n';
  std::string statuses = "exit status:";
  for (const ExitStatus& s : exit_statuses)
    statuses += (s.status > 0 ? ", " : " ") + std::to_string(s.status) + ' ' + s.meaning;
  out << '\n';
  for (const std::string& line : wrapped(statuses, page_width))
    out << line << '\n';
  return out.str();
}

} // namespace molmesh::cli
