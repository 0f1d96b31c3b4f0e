// The file dialog's pictures, from the rows it drew to textures for the next frame.
#pragma once

#include "viewer/session.h"

namespace astrosplat {

/// Fills Status::thumbnails with those of view.listed_pictures that are read; the others' textures go.
void show_thumbnails(Session& session);

}  // namespace astrosplat
