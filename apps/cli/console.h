// What the program says: results on the standard output, everything else on the standard error.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace contrejour::cli {

using Json = nlohmann::ordered_json;

// What is printed holds no control characters but line ends and tabs (printable.h), whatever files' names and texts do.
void print(const std::string& text);  // a result, on the standard output
void print_summary(const std::string& text);  // likewise, but of no matter: what was asked for is in files
void print_error(const std::string& message);  // "contrejour: message", in one line
void print_warnings(const std::vector<std::string>& warnings);

// Two spaces of indent, every digit of a number, bytes that are not UTF-8 replaced; ends with a newline.
[[nodiscard]] std::string json_text(const Json& json);
void print_json(const Json& json);

// False if something could not be written, e.g. to a full disk.
bool flush_output();

}  // namespace contrejour::cli
