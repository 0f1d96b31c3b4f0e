// The widgets of values, one for every type of parameter.
#pragma once

#include "gui/panel/row.h"

namespace astrosplat::panel {

/// The value's widget by the parameter's type. True where it took more than one row's height, and the cursor
/// stands below it already.
bool value_field(Context& context, const Row& row);

}  // namespace astrosplat::panel
