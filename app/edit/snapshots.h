// A named look, kept beside the document to compare with and to go back to (on disk: snapshot_files.h).
#pragma once

#include <memory>
#include <string>

#include "edit/document.h"
#include "scene/scene.h"

namespace astrosplat {

/// Everything as it was when it was taken.
struct StoredLook {
    std::string name;
    std::shared_ptr<const Scene> scene;
    double frame = 1.0;
};

StoredLook store_look(const std::string& name, const Document& document, double frame);

/// `scene` with the look of `stored`: look, render and visibility of the layers that both have by name, the
/// output's exposure, and the animation of all these. Camera, sources, transforms and layers that `stored`
/// lacks stay.
Scene with_look_of(const Scene& scene, const Scene& stored);

/// with_look_of as one undo step. Throws InputError as Document::edit does.
void restore_look(Document& document, const StoredLook& stored);

}  // namespace astrosplat
