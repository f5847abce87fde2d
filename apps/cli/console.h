// SPDX-License-Identifier: Apache-2.0
// The program's output: results on the standard output, everything else on the standard error.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace contrejour::cli {

using Json = nlohmann::ordered_json;

// Printed text contains no control characters except line ends and tabs (printable.h), whatever names and texts of
// files contain.
void print(const std::string& text);  // a result, on the standard output
void print_summary(const std::string& text);  // a summary, on the standard output: the results are in files
void print_error(const std::string& message);  // "contrejour: message", in one line
void print_warnings(const std::vector<std::string>& warnings);

// JSON with an indent of two spaces, every digit of a number, and bytes that are not UTF-8 replaced; ends with a
// newline.
[[nodiscard]] std::string json_text(const Json& json);
[[nodiscard]] std::string json_line(const Json& json);  // the same in one line
void print_json(const Json& json);

// Returns false if something could not be written, e.g. to a full disk.
bool flush_output();

}  // namespace contrejour::cli
