// SPDX-License-Identifier: Apache-2.0
#include "studio/core/autosave.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <system_error>
#include <utility>

#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "contrejour/expert/output_file.h"
#include "contrejour/expert/parameter_text.h"

namespace contrejour::studio {
namespace {

constexpr const char* kFileKey = "autosave-of";
constexpr const char* kPrefix = "autosave-";

Result<void> write_text(const std::filesystem::path& path, std::string_view text) {
  auto file = OutputFile::create(path);
  if (!file) return tl::unexpected(file.error());
  if (auto ok = file->write(text); !ok) return ok;
  return file->commit();
}

bool is_running(int pid) { return kill(pid, 0) == 0 || errno == EPERM; }

// The process number in "autosave-123.session.json".
std::optional<int> writer_of(const std::filesystem::path& copy) {
  const std::string name = copy.filename().string();
  if (!name.starts_with(kPrefix) || !is_session(name)) return std::nullopt;
  const std::string_view prefix(kPrefix);
  const auto pid = params::parse_integer(std::string_view(name).substr(prefix.size(), name.find('.') - prefix.size()));
  return pid ? std::optional<int>(*pid) : std::nullopt;
}

std::string original_of(const Session& session) {
  for (const SessionMember& member : session.others)
    if (member.key == kFileKey)
      if (const auto json = nlohmann::json::parse(member.json, nullptr, false); json.is_string())
        return json.get<std::string>();
  return "";
}

std::chrono::seconds age_of(const std::filesystem::path& file) {
  std::error_code code;
  const auto written = std::filesystem::last_write_time(file, code);
  if (code) return {};
  return std::chrono::duration_cast<std::chrono::seconds>(std::filesystem::file_time_type::clock::now() - written);
}

}  // namespace

std::filesystem::path state_folder() {
  const char* state = std::getenv("XDG_STATE_HOME");
  const char* home = std::getenv("HOME");
  if (state != nullptr && *state != '\0') return std::filesystem::path(state) / "contrejour" / "studio";
  if (home != nullptr && *home != '\0') return std::filesystem::path(home) / ".local/state/contrejour/studio";
  return {};
}

Autosave::Autosave(std::filesystem::path folder) : folder_(std::move(folder)), last_(std::chrono::steady_clock::now()) {
  if (!folder_.empty()) file_ = folder_ / fmt::format("{}{}.session.json", kPrefix, getpid());
}

Result<void> Autosave::save(const Document& document, const std::string& of_file, bool now) {
  if (file_.empty()) return {};
  const auto time = std::chrono::steady_clock::now();
  if (!now && time - last_ < kInterval) return {};
  last_ = time;
  Session session = session_of(document);
  session.others.push_back({kFileKey, nlohmann::json(of_file).dump()});
  std::string text = write_session(session);
  if (text == written_) return {};
  std::error_code code;
  std::filesystem::create_directories(folder_, code);
  if (auto ok = write_text(file_, text); !ok) return ok;
  written_ = std::move(text);
  return {};
}

void Autosave::forget() {
  std::error_code code;
  if (!file_.empty()) std::filesystem::remove(file_, code);
  written_.clear();
}

std::vector<LostWork> Autosave::lost_work() const {
  std::vector<LostWork> found;
  std::error_code code;
  if (folder_.empty()) return found;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, code)) {
    const auto pid = writer_of(entry.path());
    if (!pid || is_running(*pid)) continue;
    const auto session = read_session(entry.path());
    if (session) found.push_back({entry.path(), original_of(*session), session->lens, age_of(entry.path())});
  }
  std::sort(found.begin(), found.end(), [](const LostWork& a, const LostWork& b) { return a.age < b.age; });
  return found;
}

void Autosave::remove(const LostWork& work) {
  std::error_code code;
  std::filesystem::remove(work.copy, code);
}

}  // namespace contrejour::studio
