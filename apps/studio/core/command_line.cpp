// SPDX-License-Identifier: Apache-2.0
#include "studio/core/command_line.h"

#include <algorithm>
#include <cctype>

namespace contrejour::studio {
namespace {

bool is_plain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("-_./,:=@+%").find(c) != std::string_view::npos;
}

// As a POSIX shell reads it.
std::string quoted(const std::string& word) {
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string out = "'";
  for (const char c : word) {
    if (c == '\'')
      out += "'\\''";
    else
      out += c;
  }
  return out + "'";
}

std::string option_of(const params::Parameter& p, const std::string& text) {
  const std::string name(p.name);
  if (p.kind == params::Kind::Switch) return text == "on" ? " --" + name : " --no-" + name;
  return " --" + name + (text.starts_with("-") ? "=" : " ") + quoted(text);
}

}  // namespace

std::string command_of_session(const std::string& file, const std::string& output) {
  return "contrejour render --session " + quoted(file) + " -o " + quoted(output);
}

std::string command_of_values(const Document& document, const std::string& output) {
  if (document.lens_was_edited) return "";
  std::string command = "contrejour render " + quoted(document.lens_name);
  for (const auto& [name, texts] : document.texts)
    for (const std::string& text : texts) command += option_of(params::parameter(name), text);
  return command + " -o " + quoted(output);
}

}  // namespace contrejour::studio
