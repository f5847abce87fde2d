// Strict, typed access to one TOML table: every key must be known, every value of the right type and finite.
// The first error is kept and later calls return defaults, so readers stay free of error plumbing: look at
// TomlErrors::failed() before using what was read.
#pragma once

// toml++ reports what is wrong by value: nothing in this library throws.
#define TOML_EXCEPTIONS 0
#define TOML_HEADER_ONLY 1
#define TOML_ENABLE_FORMATTERS 0
// toml++ states some preconditions which a broken file can break (`a = [}`): they abort a debug build and are
// promises to clang's optimiser in a release one. Without them such files meet its ordinary errors; the fuzz
// harness lens_toml holds it to that.
#if __has_include(<toml++/impl/preprocessor.hpp>)
#include <toml++/impl/preprocessor.hpp>
#else
#include <toml++/impl/preprocessor.h>
#endif
#undef TOML_ASSERT
#undef TOML_ASSERT_ASSUME
#define TOML_ASSERT(expr) static_assert(true)
#define TOML_ASSERT_ASSUME(expr) static_assert(true)
#include <toml++/toml.h>

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "contrejour/result.h"

namespace contrejour {

class TomlErrors {
 public:
  explicit TomlErrors(std::string file) : file_(std::move(file)) {}

  void fail(const toml::source_region& where, std::string message);
  void fail(const toml::node& where, std::string message) { fail(where.source(), std::move(message)); }
  [[nodiscard]] bool failed() const { return error_.has_value(); }
  [[nodiscard]] Error error() const { return *error_; }

 private:
  std::string file_;
  std::optional<Error> error_;
};

// Inclusive bounds of a number, and what to do when it lies outside.
struct NumberRange {
  double low = 0.0;
  double high = 0.0;
};

class TomlFields {
 public:
  // what: how errors call the table, e.g. "surface 3". An unknown key is an error at once.
  TomlFields(const toml::table& table, std::string what, std::initializer_list<std::string_view> known,
             TomlErrors& errors);

  [[nodiscard]] const toml::node* find(std::string_view key) const { return table_.get(key); }
  [[nodiscard]] bool has(std::string_view key) const { return find(key) != nullptr; }
  [[nodiscard]] const std::string& what() const { return what_; }

  // Absent keys: an error that repeats `remedy`.
  std::string required_text(std::string_view key, std::string_view remedy);
  double required_number(std::string_view key, NumberRange range, std::string_view remedy);

  std::optional<std::string> text(std::string_view key);
  std::optional<double> number(std::string_view key, NumberRange range);
  std::optional<bool> boolean(std::string_view key);
  const toml::table* table(std::string_view key);
  const toml::array* array(std::string_view key);

  // For values that are not at a key.
  double number_at(const toml::node& node, std::string_view name, NumberRange range);

  void fail(const toml::node& where, std::string_view message);
  void fail_here(std::string_view message) { fail(table_, message); }

 private:
  void refuse_unknown_keys(std::initializer_list<std::string_view> known);
  void fail_type(const toml::node& node, std::string_view key, std::string_view wanted);

  const toml::table& table_;
  std::string what_;
  TomlErrors& errors_;
};

// Parses the whole text, after find_toml_fault() has found nothing: bounded in memory, time and stack.
Result<toml::table> parse_toml(std::string_view text, const std::string& file);

}  // namespace contrejour
