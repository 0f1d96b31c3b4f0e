// The panel as a whole: layers list above, tabs below.
#include "gui/panel/panel.h"

namespace astrosplat {

struct Panel::State {
    std::vector<DrawnRow> rows;
};

Panel::Panel() : state_(std::make_unique<State>()) {}
Panel::~Panel() = default;

void Panel::draw(Document&, ViewState&, const Status&, Commands&) { state_->rows.clear(); }

const std::vector<DrawnRow>& Panel::rows() const { return state_->rows; }

bool Panel::busy() const { return false; }

}  // namespace astrosplat
