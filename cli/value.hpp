// value.hpp — what the run report holds: numbers, words, lists and named fields.
#pragma once
#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace molmesh::cli {

/// Fields keep the order in which they are added. A value without an argument has no fields yet.
class Value {
public:
  using Field = std::pair<std::string, Value>;
  using List = std::vector<Value>;
  using Fields = std::vector<Field>;

  Value() : value_(Fields{}) {}
  Value(bool b) : value_(b) {}
  template <std::integral T>
  Value(T n) : value_(static_cast<int64_t>(n)) {}
  Value(double x) : value_(x) {}
  Value(const char* text) : value_(std::string(text)) {}
  Value(std::string text) : value_(std::move(text)) {}
  template <class T>
  Value(const std::vector<T>& list) : value_(List(list.begin(), list.end())) {}
  template <class T>
  Value(const std::map<std::string, T>& named) : value_(Fields(named.begin(), named.end())) {}
  Value(List list) : value_(std::move(list)) {}
  Value(std::initializer_list<Field> fields) : value_(Fields(fields)) {}

  /// The field of that name, which is added where there is none. Only of a value with fields.
  Value& operator[](const std::string& name) {
    auto& fields = std::get<Fields>(value_);
    for (Field& f : fields)
      if (f.first == name)
        return f.second;
    return fields.emplace_back(name, Value()).second;
  }
  void add(std::initializer_list<Field> more) {
    for (const Field& f : more)
      (*this)[f.first] = f.second;
  }
  const std::variant<bool, int64_t, double, std::string, List, Fields>& get() const { return value_; }

private:
  std::variant<bool, int64_t, double, std::string, List, Fields> value_;
};

} // namespace molmesh::cli
