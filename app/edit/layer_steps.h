// The edits of the list of layers that the window makes, one undo step each, "Hide dust"; the selection
// follows. Throw InputError as Document::edit does.
#pragma once

#include "edit/document.h"
#include "edit/view_state.h"

namespace astrosplat {

/// Shows a layer that is hidden at the view's frame, or hides it: by a keyframe there where that is animated.
void toggle_visible(Document& document, const ViewState& view, std::size_t index);
void duplicate_layer(Document& document, ViewState& view, std::size_t index);
void remove_layer(Document& document, ViewState& view, std::size_t index);
void move_layer(Document& document, ViewState& view, std::size_t from, std::size_t to);

/// Only layers that are solo are seen, while there are any; of the window, not of the scene.
void toggle_solo(ViewState& view, const std::string& layer);

}  // namespace astrosplat
