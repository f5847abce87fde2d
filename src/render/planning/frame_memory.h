// SPDX-License-Identifier: Apache-2.0
// Recycled image memory: the pictures that a session has written out and does not need any more serve its next frame. A
// new picture of 25 MB costs some milliseconds, since the system clears its pages first.
// Thread-safety: from one thread at a time.
#pragma once

#include "contrejour/image.h"
#include "render/planning/render_cache.h"

namespace contrejour::inline internal {

// An image of three channels with undefined pixels, for a caller that writes them all.
[[nodiscard]] Image unwritten_image(RenderCache& cache, int width, int height);

void keep_memory(RenderCache& cache, Image image);

}  // namespace contrejour::inline internal
