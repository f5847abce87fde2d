// SPDX-License-Identifier: Apache-2.0
#include "cli/lens_page.h"

#include <algorithm>
#include <cstdint>
#include <span>

#include <fmt/format.h>
#include "contrejour/expert/svg.h"

namespace contrejour::cli {
namespace {

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>Lenses</title>
<style>
body { font: 15px/1.4 sans-serif; margin: 1.5em; background: #181a1d; color: #ddd; }
#cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(340px, 1fr)); gap: 1em; }
.card { background: #24272b; border-radius: 6px; overflow: hidden; }
.card img { width: 100%; display: block; background: #000; }
.card img.section { background: #fff; height: 150px; object-fit: contain; }
.card h2 { font-size: 1em; margin: .6em .8em 0; overflow-wrap: anywhere; }
.card p { margin: .2em .8em .8em; color: #aaa; overflow-wrap: anywhere; }
input, select { font: inherit; background: #24272b; color: inherit; border: 1px solid #555; padding: .3em; }
[hidden] { display: none; }
</style>
</head>
<body>
)";

constexpr const char* kControls = R"(<p>
<input id="search" type="search" placeholder="search" aria-label="search">
<select id="order" aria-label="order">
<option value="index">as listed</option>
<option value="focal">by focal length</option>
<option value="fnumber">by f-number</option>
<option value="ghosts">by number of ghosts</option>
<option value="flare">by brightness of the flare</option>
</select>
</p>
)";

constexpr const char* kScript = R"(<script>
const cards = document.getElementById("cards"), search = document.getElementById("search"), order = document.getElementById("order");
function show() {
  const words = search.value.toLowerCase().split(/\s+/);
  const all = [...cards.children];
  for (const card of all) card.hidden = !words.every(word => card.dataset.words.includes(word));
  const sign = order.value === "ghosts" || order.value === "flare" ? -1 : 1;
  all.sort((a, b) => sign * (a.dataset[order.value] - b.dataset[order.value]) || a.dataset.index - b.dataset.index);
  cards.append(...all);
}
search.addEventListener("input", show);
order.addEventListener("change", show);
</script>
</body>
</html>
)";

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

std::string card_html(const LensCard& card, std::size_t index) {
  std::string html = fmt::format(
      "<div class=\"card\" data-index=\"{}\" data-focal=\"{:.6g}\" data-fnumber=\"{:.6g}\" data-ghosts=\"{}\" "
      "data-flare=\"{:.6g}\" data-words=\"{}\">\n",
      index, card.focal_length_mm, card.f_number, card.ghosts, card.flare,
      markup_text(lower(card.id + " " + card.name + " " + card.source)));
  html += "<img alt=\"flare\" src=\"" + data_uri("image/png", card.picture) + "\">\n";
  // The section is embedded as a picture, so that names of parts within its SVG do not collide with the page's.
  html += "<img class=\"section\" alt=\"section\" src=\"" +
          data_uri("image/svg+xml", std::as_bytes(std::span(card.section))) + "\">\n";
  html += fmt::format(
      "<h2>{}</h2>\n<p>{} mm f/{:.3g}, {} surfaces, {} ghosts; flare {:.2g} of the light, shown {:+.1f} "
      "stops<br>{}<br>{}</p>\n</div>\n",
      markup_text(card.name), markup_text(card.focal_lengths), card.f_number, card.surfaces, card.ghosts, card.flare,
      card.exposure_stops, markup_text(card.id), markup_text(card.source));
  return html;
}

}  // namespace

std::string lens_page(const std::vector<LensCard>& cards, const std::vector<RefusedLens>& refused) {
  std::string html =
      std::string(kHead) + fmt::format("<h1>{} lenses</h1>\n", cards.size()) + kControls + "<div id=\"cards\">\n";
  for (std::size_t k = 0; k < cards.size(); ++k) html += card_html(cards[k], k);
  html += "</div>\n";
  if (!refused.empty()) {
    html += fmt::format("<h1>{} refused</h1>\n<ul>\n", refused.size());
    for (const RefusedLens& lens : refused)
      html += fmt::format("<li>{}: {}</li>\n", markup_text(lens.id), markup_text(lens.reason));
    html += "</ul>\n";
  }
  return html + kScript;
}

}  // namespace contrejour::cli
