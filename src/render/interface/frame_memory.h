// The memory of pictures that a session has written and given to nobody, for its next frame: a picture of 25 MB made
// anew costs some milliseconds, since the system clears its pages first.
// Thread-safety: from one thread at a time.
#pragma once

#include "contrejour/image.h"
#include "render/interface/render_cache.h"

namespace contrejour {

// Three channels, pixels of any value, for whoever writes them all.
[[nodiscard]] Image unwritten_image(RenderCache& cache, int width, int height);

void keep_memory(RenderCache& cache, Image image);

}  // namespace contrejour
