// SPDX-License-Identifier: Apache-2.0
// Nuke's .chan files of cameras, and our CSV of points in the world.
#include <map>

#include <fmt/format.h>

#include "base/near_name.h"
#include "sequence/track_files/csv_table.h"
#include "sequence/track_files/track_lines.h"

namespace contrejour {
namespace {

constexpr std::size_t kMaxPoints = 10000;

// Frame, three of position, three of rotation, and the vertical field of view, which may be missing.
Result<CameraPose> pose_of(const TrackLine& line, const std::string& file, int frame_offset) {
  const auto fields = fields_between(line.text, " \t,");
  const auto frame = track_frame(fields[0]);
  if (!frame) return wrong_line(file, line.number, "the line does not begin with the number of a frame");
  if (fields.size() != 7 && fields.size() != 8)
    return wrong_line(file, line.number,
                      fmt::format("frame {} has {} numbers, not 7 (frame, position, rotation) or 8 (and the vertical "
                                  "field of view)",
                                  *frame, fields.size()));
  double numbers[7] = {};
  for (std::size_t k = 1; k < fields.size(); ++k) {
    const auto number = track_number(fields[k]);
    if (!number)
      return wrong_line(file, line.number,
                        fmt::format("frame {}: \"{}\" is not a number", *frame, shortened(fields[k])));
    numbers[k - 1] = *number;
  }
  CameraPose pose{
      *frame + frame_offset, {numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}, {}};
  if (fields.size() == 8) {
    if (!(numbers[6] >= 0.01 && numbers[6] <= 175.0))
      return wrong_line(file, line.number,
                        fmt::format("frame {}: the vertical field of view is not from 0.01 to 175 degrees", *frame));
    pose.vertical_fov_deg = numbers[6];
  }
  return pose;
}

Result<void> check_follows(const CameraPose& before, const CameraPose& pose, const std::string& file, int line,
                           int frame_offset) {
  const int expected = before.frame + 1 - frame_offset, frame = pose.frame - frame_offset;
  if (frame > expected)
    return wrong_line(file, line, fmt::format("frame {} is missing: the line is that of frame {}", expected, frame));
  if (frame < expected)
    return wrong_line(file, line, fmt::format("frame {} comes after frame {}", frame, expected - 1));
  if (pose.vertical_fov_deg.has_value() != before.vertical_fov_deg.has_value())
    return wrong_line(file, line, fmt::format("frame {}: some lines have a field of view and others have none", frame));
  return {};
}

}  // namespace

Result<std::vector<CameraPose>> read_chan(std::string_view text, const std::string& file, int frame_offset) {
  if (auto ok = check_frame_offset(frame_offset); !ok) return tl::unexpected(ok.error());
  std::vector<CameraPose> camera;
  for (const TrackLine& line : track_lines(text, "#")) {
    if (fields_between(line.text, " \t,").empty()) continue;
    const auto pose = pose_of(line, file, frame_offset);
    if (!pose) return tl::unexpected(pose.error());
    if (!camera.empty())
      if (auto ok = check_follows(camera.back(), *pose, file, line.number, frame_offset); !ok)
        return tl::unexpected(ok.error());
    camera.push_back(*pose);
  }
  if (camera.empty()) return failure(ErrorCode::Parse, "the file has no frame of a camera", {file, 0, 0});
  return camera;
}

Result<std::vector<WorldPoint>> read_world_points(std::string_view text, const std::string& file, int frame_offset) {
  if (auto ok = check_frame_offset(frame_offset); !ok) return tl::unexpected(ok.error());
  const auto table = read_csv_table(text, file, {"x", "y", "z"});
  if (!table) return tl::unexpected(table.error());
  std::vector<WorldPoint> points;
  std::vector<std::map<int, Vec3>> positions;
  std::map<std::string_view, std::size_t> by_name;
  for (const CsvRow& row : table->rows) {
    if (row.name.empty()) return wrong_line(file, row.line, "the point has no name");
    const auto [at, is_new] = by_name.emplace(row.name, points.size());
    if (is_new) {
      if (points.size() == kMaxPoints)
        return wrong_line(file, row.line, fmt::format("more than {} points", kMaxPoints));
      points.push_back({std::string(row.name), {}, table->has_frames});
      positions.emplace_back();
    }
    const int frame = table->has_frames ? static_cast<int>(row.numbers[3]) : 0;
    const Vec3 position{row.numbers[0], row.numbers[1], row.numbers[2]};
    if (!positions[at->second].emplace(table->has_frames ? frame + frame_offset : 0, position).second)
      return wrong_line(file, row.line,
                        fmt::format("\"{}\" has two positions{}", shortened(row.name),
                                    table->has_frames ? fmt::format(" in frame {}", frame) : ""));
  }
  if (points.empty()) return failure(ErrorCode::Parse, "the file has no point", {file, 0, 0});
  for (std::size_t k = 0; k < points.size(); ++k)
    for (const auto& [frame, position] : positions[k]) points[k].keys.push_back({frame, position});
  return points;
}

}  // namespace contrejour
