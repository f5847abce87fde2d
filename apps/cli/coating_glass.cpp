#include "cli/coating_glass.h"

#include <fmt/format.h>

#include "params/parse.h"

namespace contrejour::cli {

void add_glass_option(CLI::App& command, std::string& text) {
  text = "1.5168,64.17";
  command.add_option("--glass", text, "what it lies on: an index, or n_d and Abbe number")->type_name("N|N_D,V_D")
      ->capture_default_str();
}

Result<Glass> parse_glass(const std::string& text) {
  const std::size_t comma = text.find(',');
  const auto n = params::parse_real(text.substr(0, comma));
  const auto v = comma == std::string::npos ? Result<double>(0.0) : params::parse_real(text.substr(comma + 1));
  if (!n || !v || !(*n >= 1.0 && *n <= 4.0) || !(*v == 0.0 || (*v >= 10.0 && *v <= 150.0))) {
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("\"{}\" is no glass; write an index from 1 to 4, or n_d and an Abbe number from 10 to 150 "
                               "as in 1.5168,64.17", text));
  }
  return Glass{text, AbbeGlass{*n, *v}};
}

}  // namespace contrejour::cli
