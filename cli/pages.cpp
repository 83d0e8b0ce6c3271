// pages.cpp — man page, page of the docs, completion in bash.
#include "cli/pages.hpp"
#include "cli/run.hpp"
#include "cli/text.hpp"
#include <algorithm>
#include <cstdio>
#include <sstream>

namespace molmesh::cli {
namespace {

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? char(c - 32) : c; });
  return text;
}

std::string capitalized(std::string text) {
  return text.empty() ? text : upper(text.substr(0, 1)) + text.substr(1);
}

/// The character at text[i], which is UTF-8; i is moved behind it.
unsigned character(const std::string& text, size_t& i) {
  const auto byte = static_cast<unsigned char>(text[i++]);
  unsigned c = byte < 0x80 ? byte : byte < 0xE0 ? byte & 0x1F : byte < 0xF0 ? byte & 0x0F : byte & 0x07;
  while (byte >= 0xC0 && i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80)
    c = c << 6 | (static_cast<unsigned char>(text[i++]) & 0x3F);
  return c;
}

/// Text of a man page: no character has another meaning there.
std::string roff(const std::string& text) {
  std::string out;
  for (size_t i = 0; i < text.size();) {
    const unsigned c = character(text, i);
    char code[16];
    if (c >= 0x80) {
      std::snprintf(code, sizeof code, "\\[u%04X]", c);
      out += code;
    } else if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if (c == '\'')
      out += "\\(aq";
    else if (c == '`')
      out += "\\(ga";
    else if (c == '^')
      out += "\\(ha";
    else if (c == '~')
      out += "\\(ti";
    else
      out += (out.empty() && c == '.' ? "\\&" : "") + std::string(1, static_cast<char>(c));
  }
  return out;
}

/// "-t, --threads N", names bold, what stands for the value in italics.
std::string roff_name(const Option& o) {
  if (o.argument)
    return "\\fI" + roff(o.name) + "\\fR";
  std::string text = o.letter.empty() ? "" : "\\fB\\-" + o.letter + "\\fR, ";
  text += "\\fB" + roff("--" + o.name) + "\\fR";
  return o.flag() ? text : text + " \\fI" + roff(o.shown_unit()) + "\\fR";
}

/// Not capitalized: it may begin with a word of the command line.
std::string with_notes(const Option& o) {
  const std::string notes = notes_of(o);
  return notes.empty() ? o.meaning : o.meaning + " (" + notes + ")";
}

std::string synopsis_arguments(const Table& table) {
  std::string text;
  for (const Option& o : table.options)
    if (o.argument)
      text += o.must_be_given ? " " + o.name : " [" + o.name + "]";
  return text;
}

/// A cell of a table; pages of formats are links.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '|' ? std::string("\\|") : std::string(1, c);
  for (size_t page = 0; (page = out.find("formats/", page)) != std::string::npos;) {
    const std::string path = out.substr(page, out.find_first_of(" ,)", page) - page);
    const std::string link = "[" + path + "](../../" + path + ")";
    out.replace(page, path.size(), link);
    page += link.size();
  }
  return out;
}

/// The line of a man page that whatis(1) shows.
std::string without_stop(const std::string& text) {
  return !text.empty() && text.back() == '.' ? text.substr(0, text.size() - 1) : text;
}

} // namespace

std::string man_page(const Table& table) {
  std::ostringstream out;
  out << ".TH " << upper(table.program) << " 1 \"\" \"" << roff("molmesh " + version()) << "\" \"molmesh\"\n"
      << ".nh\n.ad l\n" // no hyphens in names, no widened lines
      << ".SH NAME\n"
      << roff(table.program) << " \\- " << roff(without_stop(table.purpose)) << "\n.SH SYNOPSIS\n.B "
      << roff(table.program) << "\n[\\fIOPTIONS\\fR]" << roff(synopsis_arguments(table)) << "\n.SH DESCRIPTION\n"
      << roff(table.page.about) << '\n';
  for (const Option& o : table.options)
    if (o.argument)
      out << ".TP\n" << roff_name(o) << '\n' << roff(with_notes(o)) << '\n';
  out << ".SH OPTIONS\n";
  for (const OptionGroup& group : grouped(table)) {
    out << ".SS " << roff(capitalized(group.heading)) << '\n';
    for (const Option* o : group.options)
      out << ".TP\n" << roff_name(*o) << '\n' << roff(with_notes(*o)) << '\n';
  }
  if (!table.page.examples.empty())
    out << ".SH EXAMPLES\n";
  for (const Page::Example& e : table.page.examples)
    out << ".TP\n\\fB" << roff(e.command) << "\\fR\n" << roff(capitalized(e.meaning)) << ".\n";
  out << ".SH EXIT STATUS\n";
  for (const ExitStatus& s : exit_statuses)
    out << ".TP\n\\fB" << s.status << "\\fR\n" << roff(capitalized(s.meaning)) << ".\n";
  if (!table.page.files.empty())
    out << ".SH FILES\n";
  for (const Page::File& f : table.page.files)
    out << ".TP\n\\fI" << roff(f.name) << "\\fR\n" << roff(capitalized(f.meaning)) << ".\n";
  out << ".SH SEE ALSO\n";
  for (size_t i = 0; i < table.page.see_also.size(); ++i)
    out << ".BR " << roff(table.page.see_also[i]) << (i + 1 < table.page.see_also.size() ? " (1),\n" : " (1)\n");
  return out.str();
}

std::string markdown_page(const Table& table) {
  std::ostringstream out;
  out << "# " << table.program
      << "\n\n<!-- Made from the program's options by `cmake --build build --target program_pages`. "
         "-->\n\n"
      << table.purpose << "\n\n    " << table.program << " [OPTIONS]" << synopsis_arguments(table) << "\n\n";
  for (const std::string& line : wrapped(table.page.about, 120))
    out << line << '\n';
  out << "\n| argument | meaning |\n|---|---|\n";
  for (const Option& o : table.options)
    if (o.argument)
      out << "| `" << o.name << "` | " << cell(with_notes(o)) << " |\n";
  out << "\n## Options\n";
  for (const OptionGroup& group : grouped(table)) {
    out << "\n### " << capitalized(group.heading)
        << "\n\n| option | meaning | range | default |\n|---|---|---|---|\n";
    for (const Option* o : group.options) {
      std::string range = o->shown_range();
      if (o->several())
        range += std::string(range.empty() ? "" : "; ") + "repeatable";
      out << "| `" << (o->letter.empty() ? "" : "-" + o->letter + ", ") << "--" << o->name
          << (o->flag() ? "" : " " + cell(o->shown_unit())) << "` | " << cell(o->meaning) << " | " << cell(range)
          << " | " << (o->flag() || o->default_text.empty() ? "" : "`" + o->default_text + "`") << " |\n";
    }
  }
  if (!table.page.examples.empty())
    out << "\n## Examples\n";
  for (const Page::Example& e : table.page.examples)
    out << '\n' << capitalized(e.meaning) << ":\n\n    " << e.command << '\n';
  out << "\n## Exit status\n\n| status | meaning |\n|---|---|\n";
  for (const ExitStatus& s : exit_statuses)
    out << "| " << s.status << " | " << s.meaning << " |\n";
  if (!table.page.files.empty())
    out << "\n## Files\n\n| file | meaning |\n|---|---|\n";
  for (const Page::File& f : table.page.files)
    out << "| `" << f.name << "` | " << cell(f.meaning) << " |\n";
  out << "\n## See also\n\n";
  for (size_t i = 0; i < table.page.see_also.size(); ++i)
    out << (i > 0 ? ", " : "") << '[' << table.page.see_also[i] << "](" << table.page.see_also[i] << ".md)";
  out << '\n';
  return out.str();
}

std::string bash_completion(const Table& table) {
  std::ostringstream out;
  std::string all, any_text;
  out << "# Completion of " << table.program << " in bash, made from its options.\n_molmesh_" << table.program
      << "() {\n"
      << "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
      << "  if [[ $word == = ]]; then word= before=${COMP_WORDS[COMP_CWORD-1]}; fi\n" // --mode=, which bash splits
      << "  if [[ $before == = ]]; then before=${COMP_WORDS[COMP_CWORD-2]}; fi\n"
      << "  case $before in\n";
  for (const Option& o : table.options) {
    if (o.argument)
      continue;
    const std::string names = (o.letter.empty() ? "" : "-" + o.letter + " | ") + "--" + o.name;
    all += (all.empty() ? "" : " ") + std::string("--") + o.name;
    if (o.flag() || o.value_name == "FILE")
      continue; // files are completed as arguments are
    std::string words;
    for (const std::string& word : o.words)
      words += (words.empty() ? "" : " ") + word;
    if (words.empty())
      any_text += (any_text.empty() ? "" : " | ") + names;
    else
      out << "  " << names << ") mapfile -t COMPREPLY < <(compgen -W '" << words << "' -- \"$word\"); return ;;\n";
  }
  if (!any_text.empty())
    out << "  " << any_text << ") return ;;\n";
  out << "  esac\n"
      << "  if [[ $word == -* ]]; then\n    mapfile -t COMPREPLY < <(compgen -W '" << all
      << "' -- \"$word\")\n  else\n    mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n  fi\n}\n"
      << "complete -o filenames -F _molmesh_" << table.program << ' ' << table.program << '\n';
  return out.str();
}

} // namespace molmesh::cli
