// SPDX-License-Identifier: Apache-2.0
#include "cli/console.h"

#include <cstdio>

#include "cli/printable.h"
#include "cli/terminal.h"

namespace contrejour::cli {

namespace {

void write_to(std::FILE* stream, const std::string& text) { std::fwrite(text.data(), 1, text.size(), stream); }

}  // namespace

void print(const std::string& text) { write_to(stdout, printable(text, Lines::Keep)); }

void print_summary(const std::string& text) {
  std::fflush(stdout);
  write_unchecked(printable(text, Lines::Keep));
}

void print_error(const std::string& message) {
  std::fflush(stdout);
  write_to(stderr, "contrejour: " + printable(message, Lines::Join) + "\n");
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) print_error("warning: " + warning);
}

std::string json_text(const Json& json) {
  return printable_json(json.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

std::string json_line(const Json& json) {
  return printable_json(json.dump(-1, ' ', false, Json::error_handler_t::replace)) + "\n";
}

void print_json(const Json& json) { print(json_text(json)); }

bool flush_output() { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

}  // namespace contrejour::cli
