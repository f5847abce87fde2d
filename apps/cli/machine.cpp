// SPDX-License-Identifier: Apache-2.0
#include "cli/machine.h"

#include <fstream>
#include <thread>

namespace contrejour::cli {
namespace {

// Linux lists it in /proc/cpuinfo: "model name : ...".
std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

constexpr const char* system_name() {
#if defined(_WIN32)
  return "Windows";
#elif defined(__APPLE__)
  return "macOS";
#elif defined(__linux__)
  return "Linux";
#else
  return "unknown";
#endif
}

constexpr const char* compiler_name() {
#if defined(__VERSION__) && defined(__clang__)
  return __VERSION__;
#elif defined(__VERSION__)
  return "gcc " __VERSION__;
#else
  return "unknown";
#endif
}

}  // namespace

Machine this_machine() {
  return {processor_name(), std::thread::hardware_concurrency(), system_name(), compiler_name()};
}

Json machine_json(const Machine& machine) {
  return {{"processor", machine.processor},
          {"cores", machine.cores},
          {"system", machine.system},
          {"compiler", machine.compiler}};
}

}  // namespace contrejour::cli
