#include "cli/console.h"

#include <cstdio>

namespace contrejour::cli {

void print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

void print_error(const std::string& message) {
  std::fflush(stdout);
  const std::string line = "contrejour: " + message + "\n";
  std::fwrite(line.data(), 1, line.size(), stderr);
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) print_error("warning: " + warning);
}

std::string json_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

void print_json(const Json& json) { print(json_text(json)); }

bool flush_output() { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

}  // namespace contrejour::cli
