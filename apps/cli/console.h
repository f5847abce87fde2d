// What the program says: results on the standard output, everything else on the standard error.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace contrejour::cli {

using Json = nlohmann::ordered_json;

void print(const std::string& text);             // as it is, on the standard output
void print_error(const std::string& message);    // "contrejour: message"
void print_warnings(const std::vector<std::string>& warnings);

// Two spaces of indent, every digit of a number, bytes that are not UTF-8 replaced; ends with a newline.
[[nodiscard]] std::string json_text(const Json& json);
void print_json(const Json& json);

// False if something could not be written, e.g. to a full disk.
bool flush_output();

}  // namespace contrejour::cli
