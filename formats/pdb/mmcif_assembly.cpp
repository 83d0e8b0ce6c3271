// mmcif_assembly.cpp — operator expressions and their products.
#include "formats/pdb/mmcif_assembly.hpp"
#include "base/error.hpp"
#include "formats/pdb/parse.hpp"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <gemmi/numb.hpp>
#include <map>
#include <set>

namespace molmesh::formats {
namespace {
namespace cif = gemmi::cif;

constexpr size_t most_operators = 100'000;

/// "1-60", "61", "1,2,6", "P": identifiers, ranges of numbers spelled out.
std::vector<std::string> parse_list(std::string_view list, const std::string& where) {
  std::vector<std::string> ids;
  while (true) {
    const size_t comma = std::min(list.find(','), list.size());
    const std::string_view item = list.substr(0, comma);
    int first = 0, last = 0;
    const char* end = item.data() + item.size();
    const auto [dash, error] = std::from_chars(item.data(), end, first);
    const bool is_range = error == std::errc{} && dash != end && *dash == '-' &&
                          std::from_chars(dash + 1, end, last).ptr == end && dash + 1 != end;
    if (item.empty() || item.find_first_of("() ") != std::string_view::npos || (is_range && last < first))
      fail_input(where + ": found operators " + in_quotes(list) + ", expected identifiers and ranges");
    if (is_range && static_cast<size_t>(last - first) >= most_operators)
      fail_input(where + ": found more than 100000 operators in " + in_quotes(item) + ", expected fewer");
    if (is_range)
      for (int n = first; n <= last; ++n)
        ids.push_back(std::to_string(n));
    else
      ids.emplace_back(item);
    if (ids.size() > most_operators)
      fail_input(where + ": found more than 100000 operators, expected fewer");
    if (comma == list.size())
      return ids;
    list.remove_prefix(comma + 1);
  }
}

std::map<std::string, gemmi::Transform> read_operators(cif::Block& block, const std::string& file) {
  std::vector<std::string> tags = {"id"};
  for (const char* row : {"1", "2", "3"}) {
    for (const char* column : {"1", "2", "3"})
      tags.push_back(std::string("matrix[") + row + "][" + column + "]");
    tags.push_back(std::string("vector[") + row + "]");
  }
  std::map<std::string, gemmi::Transform> operators;
  for (const auto row : block.find("_pdbx_struct_oper_list.", tags)) {
    gemmi::Transform t;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        t.mat[i][j] = cif::as_number(row[1 + 4 * i + j]);
      t.vec.at(i) = cif::as_number(row[4 + 4 * i]);
      for (size_t k = static_cast<size_t>(1 + 4 * i); k < static_cast<size_t>(5 + 4 * i); ++k)
        if (!std::isfinite(cif::as_number(row[k])))
          fail_input(file + ": found " + in_quotes(row[k]) + " in operator " + row.str(0) +
                     " of _pdbx_struct_oper_list, expected a number");
    }
    operators.emplace(row.str(0), t);
  }
  return operators;
}

} // namespace

std::vector<std::vector<std::string>> parse_operators(std::string_view expression, const std::string& where) {
  std::vector<std::vector<std::string>> products = {{}};
  std::string_view rest = expression;
  do {
    std::string_view list = rest;
    if (!rest.empty() && rest[0] == '(') {
      const size_t close = rest.find(')');
      if (close == std::string_view::npos)
        fail_input(where + ": found operators " + in_quotes(expression) + ", expected ')'");
      list = rest.substr(1, close - 1);
      rest.remove_prefix(close + 1);
    } else {
      rest = {};
    }
    const std::vector<std::string> ids = parse_list(list, where);
    if (products.size() * ids.size() > most_operators)
      fail_input(where + ": found more than 100000 operators in " + in_quotes(expression) + ", expected fewer");
    std::vector<std::vector<std::string>> longer;
    for (const std::vector<std::string>& product : products)
      for (const std::string& id : ids) {
        longer.push_back(product);
        longer.back().push_back(id);
      }
    products = std::move(longer);
  } while (!rest.empty());
  return products;
}

std::vector<gemmi::Assembly> read_assemblies(cif::Block& block, const std::string& wanted,
                                             const std::string& file) {
  std::vector<gemmi::Assembly> assemblies;
  const std::map<std::string, gemmi::Transform> operators =
      wanted == "none" ? std::map<std::string, gemmi::Transform>() : read_operators(block, file);
  constexpr size_t most_named = 1000; // for a message
  std::set<std::string> named;
  size_t operators_of_all = 0;
  for (const auto row :
       block.find("_pdbx_struct_assembly_gen.", {"assembly_id", "oper_expression", "asym_id_list"})) {
    const std::string name = row.str(0);
    if (name != wanted) {
      if (named.size() < most_named && named.insert(name).second)
        assemblies.emplace_back(name);
      continue;
    }
    const auto known = std::find_if(assemblies.begin(), assemblies.end(),
                                    [&](const gemmi::Assembly& a) { return a.name == name; });
    gemmi::Assembly& assembly = known == assemblies.end() ? assemblies.emplace_back(name) : *known;
    gemmi::Assembly::Gen& gen = assembly.generators.emplace_back();
    gemmi::split_str_into_multi(row.str(2), ", \n", gen.subchains);
    const std::string where = file + ": assembly " + name;
    for (const std::vector<std::string>& product : parse_operators(row.str(1), where)) {
      if (++operators_of_all > most_operators)
        fail_input(where + ": found more than 100000 operators, expected fewer");
      gemmi::Assembly::Operator op;
      for (const std::string& id : product) {
        const auto found = operators.find(id);
        if (found == operators.end())
          fail_input(where + ": found operator " + in_quotes(id) + ", expected one of _pdbx_struct_oper_list");
        op.transform = op.transform.combine(found->second);
        op.name += (op.name.empty() ? "" : "*") + id;
      }
      gen.operators.push_back(op);
    }
  }
  return assemblies;
}

} // namespace molmesh::formats
