// SPDX-License-Identifier: Apache-2.0
#include "cli/protocol_page.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace contrejour::cli {
namespace {

constexpr double kSettle_s = 3.0;  // the head moves and comes to rest

constexpr const char* kProtocolHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>Protocol of a flare measurement</title>
<style>
body { font: 11pt/1.35 sans-serif; max-width: 19cm; margin: 1.2em auto; color: #111; }
h1 { font-size: 1.4em; } h2 { font-size: 1.1em; margin: 1.2em 0 .3em; }
table { border-collapse: collapse; width: 100%; }
td, th { border: 1px solid #999; padding: .15em .4em; text-align: left; }
td.fill { min-width: 5cm; }
li { margin: .15em 0; } ol.boxes, ul.boxes { list-style: "\2610  "; }
.stations { column-count: 6; font-size: 8pt; }
@media print { h2 { break-after: avoid; } table, li { break-inside: avoid; } }
</style>
</head>
<body>
<h1>Protocol of a flare measurement</h1>
)";

constexpr const char* kRecord = R"(<h2>Record</h2>
<table>
<tr><th>camera, serial number</th><td class="fill"></td><th>lens, serial number</th><td class="fill"></td></tr>
<tr><th>focal length, focus</th><td></td><th>f-number (open: round stop)</th><td></td></tr>
<tr><th>ISO (lowest)</th><td></td><th>filter, hood (none)</th><td></td></tr>
<tr><th>light, its diameter in degrees</th><td></td><th>distance to the light</th><td></td></tr>
<tr><th>date, who</th><td></td><th>room temperature, start and end</th><td></td></tr>
</table>
)";

constexpr const char* kSetUp = R"(<h2>Set-up</h2>
<ul class="boxes">
<li>Camera on a motorised head, light on a tripod, both at one height; the head's axis through the entrance pupil.</li>
<li>The light is narrow and fills the entrance pupil at every angle, and little more: look from the light's side.</li>
<li>The light subtends no more than half a degree and is far enough to count as parallel.</li>
<li>Optical axis on the light's centre at 0 degrees; camera level: the light's image stays on one row of pixels.</li>
<li>Black cloth behind the light, over tripods and floor; no reflecting surface in the field; room dark.</li>
<li>RAW without compression or noise reduction; manual exposure, focus and white balance; stabilisation off; electronic
    or delayed shutter; lens clean, correction profiles off.</li>
<li>Light warmed up for 15 minutes. A white patch beside the camera, lit by the same lamp, shows its drift.</li>
</ul>
)";

constexpr const char* kWatch = R"(<h2>What to watch</h2>
<ul class="boxes">
<li>The longest exposure shows the faintest ghost above the noise; in the shortest no ghost is saturated.</li>
<li>In the direct exposure the light's own image is below 90 per cent of saturation at every angle. Shorten it otherwise,
    and change its time in the list.</li>
<li>Both signs of the angle: ghosts mirror. If not, the axis or the level is off.</li>
<li>The angle in the list is the head's; swap its sign there if the light moves the other way (right is positive).</li>
<li>Repeat station 1 at the end: position and level of the light agree to a pixel and to a per cent.</li>
<li>Nobody moves, no door opens, no display is lit during an exposure.</li>
</ul>
)";

std::string sequence_html(const CapturePlan& plan) {
  return fmt::format(
      "<h2>Photographs</h2>\n<ol>\n<li>Before and after the sweep, lens capped: five dark frames of each time ({:g} "
      "s).</li>\n"
      "<li>At each station, after the head has settled: {:g} s, then the direct exposure of {:g} s.</li>\n"
      "<li>Every {} stations, and at the last: block the light by a black card close to the lamp (not the lens) and "
      "repeat the {:g} s.</li>\n</ol>\n",
      fmt::join(plan.times_s, " s, "), fmt::join(plan.times_s, " s, "), plan.direct_s, plan.background_every,
      fmt::join(plan.times_s, " s, "));
}

std::string totals_html(const CapturePlan& plan, std::span<const PlannedCapture> captures) {
  double seconds = 0.0;
  for (const PlannedCapture& capture : captures) seconds += capture.time_s + 1.0;
  seconds += kSettle_s * plan.stations;
  const double step_deg = plan.stations > 1 ? 2.0 * plan.to_deg / (plan.stations - 1) : 0.0;
  return fmt::format(
      "<p>{} stations from {:g} to {:g} degrees, {:g} degrees apart; {} photographs; about {:.0f} minutes.</p>\n",
      plan.stations, -plan.to_deg, plan.to_deg, step_deg, captures.size(), seconds / 60.0);
}

std::string stations_html(std::span<const PlannedCapture> captures) {
  std::set<int> with_background;
  for (const PlannedCapture& capture : captures)
    if (capture.kind == CaptureKind::Background) with_background.insert(capture.station);
  std::string html = "<h2>Stations</h2>\n<p>B: with the light blocked as well.</p>\n<div class=\"stations\">\n";
  int last = 0;
  for (const PlannedCapture& capture : captures) {
    if (capture.station == last) continue;
    last = capture.station;
    html += fmt::format("&#9744; {} &nbsp;{:+.2f}&deg;{}<br>\n", last, capture.angle_deg,
                        with_background.contains(last) ? " B" : "");
  }
  return html + "</div>\n";
}

}  // namespace

std::string protocol_page(const CapturePlan& plan, std::span<const PlannedCapture> captures) {
  return std::string(kProtocolHead) + totals_html(plan, captures) + kRecord + kSetUp + sequence_html(plan) + kWatch +
         stations_html(captures) + "</body>\n</html>\n";
}

}  // namespace contrejour::cli
