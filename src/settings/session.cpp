// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/session.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/json_members.h"
#include "base/json_tree.h"
#include "base/text_file.h"

namespace contrejour {
namespace {

constexpr std::string_view kVersionKey = "contrejour-session";
constexpr std::string_view kSessionEnding = ".session.json";

tl::unexpected<Error> wrong_session(const std::string& file, int line, std::string what) {
  return failure(ErrorCode::Parse, std::move(what), {file, line});
}

Result<void> check_version(const JsonNode& whole, const std::string& file) {
  const JsonNode* version = whole.find(kVersionKey);
  if (version == nullptr || version->kind != JsonNode::Kind::Number)
    return wrong_session(file, 1,
                         fmt::format("this is no session: it has no \"{}\" (docs/formats/session.md)", kVersionKey));
  if (version->number > kSessionVersion)
    return wrong_session(file, version->line, "a later version of contrejour wrote this session; take that version");
  return {};
}

Result<void> read_text(const JsonNode& whole, std::string_view key, const std::string& file, std::string& to) {
  const JsonNode* node = whole.find(key);
  if (node == nullptr) return {};
  if (node->kind != JsonNode::Kind::Text)
    return wrong_session(file, node->line, fmt::format("\"{}\" is not a text", key));
  to = node->text;
  return {};
}

const params::Parameter* parameter_called(std::string_view name) {
  const auto all = params::all_parameters();
  const auto found = std::find_if(all.begin(), all.end(), [&](const params::Parameter& p) {
    return p.name == name || (!name.empty() && p.former == name);
  });
  return found != all.end() ? &*found : nullptr;
}

Result<void> read_value(const JsonNode& node, const params::Parameter& p, const std::string& file,
                        params::Values& values) {
  const auto set = [&](const JsonNode& one) -> Result<void> {
    if (one.kind != JsonNode::Kind::Text)
      return wrong_session(file, one.line, fmt::format("{}: a value is a text, or a list of them", p.name));
    if (auto ok = values.set(p.name, one.text); !ok)
      return wrong_session(file, one.line, fmt::format("{}: {}", p.name, ok.error().message));
    return {};
  };
  if (node.kind != JsonNode::Kind::List) return set(node);
  if (!p.repeats && node.list.size() != 1)
    return wrong_session(file, node.line, fmt::format("{}: this has a single value; give one, not a list", p.name));
  for (const JsonNode& one : node.list)
    if (auto ok = set(one); !ok) return ok;
  return {};
}

Result<void> read_values(const JsonNode& whole, const std::string& file, params::Values& values) {
  const JsonNode* node = whole.find("values");
  if (node == nullptr) return {};
  if (node->kind != JsonNode::Kind::Map) return wrong_session(file, node->line, "\"values\" is not an object");
  for (std::size_t k = 0; k < node->list.size(); ++k) {
    const params::Parameter* p = parameter_called(node->keys[k]);
    if (p == nullptr)
      return wrong_session(
          file, node->list[k].line,
          fmt::format("\"{}\" is not a parameter (contrejour render --help)", node->keys[k].substr(0, 60)));
    if (auto ok = read_value(node->list[k], *p, file, values); !ok) return ok;
  }
  return {};
}

// The members of a plate, by their keys.
template <class Plate>
auto plate_members(Plate& plate) {
  return std::array{std::pair("file", &plate.file), std::pair("layer", &plate.layer), std::pair("part", &plate.part),
                    std::pair("input-space", &plate.input_space), std::pair("ocio-config", &plate.config)};
}

Result<void> read_session_plate(const JsonNode& whole, const std::string& file, SessionPlate& plate) {
  const JsonNode* node = whole.find("plate");
  if (node == nullptr) return {};
  if (node->kind != JsonNode::Kind::Map) return wrong_session(file, node->line, "\"plate\" is not an object");
  for (const auto& [key, text] : plate_members(plate))
    if (auto ok = read_text(*node, key, file, *text); !ok) return ok;
  if (plate.file.empty()) return wrong_session(file, node->line, "\"plate\" has no \"file\"");
  return {};
}

std::string json_of_plate(const SessionPlate& plate) {
  std::vector<JsonMember> members;
  for (const auto& [key, text] : plate_members(plate))
    if (!text->empty()) members.emplace_back(key, json_of_text(*text));
  return json_of_members(members);
}

bool is_known_member(std::string_view key) {
  return key == kVersionKey || key == "lens" || key == "prescription" || key == "values" || key == "plate" ||
         key == "animation";
}

std::string json_of_values(const params::Values& values) {
  std::vector<JsonMember> members;
  for (const params::Parameter& p : params::all_parameters()) {
    if (!values.given(p.name)) continue;
    const std::vector<std::string> texts = values.list(p.name);
    members.emplace_back(p.name, p.repeats ? json_of_texts(texts) : json_of_text(texts.front()));
  }
  return json_of_members(members);
}

}  // namespace

bool is_session(std::string_view name) {
  if (name.size() < kSessionEnding.size()) return false;
  const std::string_view end = name.substr(name.size() - kSessionEnding.size());
  return std::equal(end.begin(), end.end(), kSessionEnding.begin(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b; });
}

Result<Session> read_session(std::string_view json, const std::string& file) {
  const auto whole = parse_json(json, file);
  if (!whole) return tl::unexpected(whole.error());
  Session session;
  if (auto ok = check_version(*whole, file); !ok) return tl::unexpected(ok.error());
  if (auto ok = read_text(*whole, "lens", file, session.lens); !ok) return tl::unexpected(ok.error());
  if (auto ok = read_text(*whole, "prescription", file, session.prescription); !ok) return tl::unexpected(ok.error());
  if (auto ok = read_values(*whole, file, session.values); !ok) return tl::unexpected(ok.error());
  if (auto ok = read_session_plate(*whole, file, session.plate); !ok) return tl::unexpected(ok.error());
  if (auto ok = read_text(*whole, "animation", file, session.animation); !ok) return tl::unexpected(ok.error());
  const auto members = json_members(json, file);
  if (!members) return tl::unexpected(members.error());
  for (const auto& [key, text] : *members)
    if (!is_known_member(key)) session.others.push_back({key, text});
  return session;
}

Result<Session> read_session(const std::filesystem::path& file) {
  const auto text = read_text_file(file, kJsonMaxBytes, "give the name of a file that the studio has saved");
  if (!text) return tl::unexpected(text.error());
  return read_session(*text, file.string());
}

std::string write_session(const Session& session) {
  std::vector<JsonMember> members;
  members.reserve(6 + session.others.size());
  members.emplace_back(kVersionKey, std::to_string(kSessionVersion));
  members.emplace_back("lens", json_of_text(session.lens));
  members.emplace_back("values", json_of_values(session.values));
  if (!session.prescription.empty()) members.emplace_back("prescription", json_of_text(session.prescription));
  if (!session.plate.file.empty()) members.emplace_back("plate", json_of_plate(session.plate));
  if (!session.animation.empty()) members.emplace_back("animation", json_of_text(session.animation));
  for (const SessionMember& other : session.others)
    if (!is_known_member(other.key)) members.emplace_back(other.key, other.json);
  return json_of_members(members);
}

std::filesystem::path plate_file(const SessionPlate& plate, const std::filesystem::path& session_file) {
  if (plate.file.empty()) return {};
  return (session_file.parent_path() / plate.file).lexically_normal();  // an absolute name stays what it is
}

Result<Prescription> lens_of_session(const Session& session, const GlassCatalogue* glasses) {
  if (session.prescription.empty()) return find_lens(session.lens, glasses);
  return read_lens_toml(session.prescription, session.lens, glasses);
}

}  // namespace contrejour
