// SPDX-License-Identifier: Apache-2.0
// Memory of a session's pictures and layers, which goes back to the session when they are destroyed and serves its next
// frames (image/pixel_pool.h).
// Thread-safety: unwritten_image() from one thread at a time.
#pragma once

#include "contrejour/image.h"
#include "render/planning/render_cache.h"

namespace contrejour::inline internal {

// An image of three channels with undefined pixels, for a caller that writes them all.
[[nodiscard]] Image unwritten_image(RenderCache& cache, int width, int height);

}  // namespace contrejour::inline internal
