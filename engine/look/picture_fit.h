// The factors of opacity and light that give every part of a picture its light back when its splats are
// drawn. In: a chart and the sums of its cells. Out: four factors for each cell.
#pragma once

#include <cstdint>

#include "look/picture_cells.h"
#include "look/picture_chart.h"

namespace astrosplat {

/// Of alpha * color for red, green and blue, and of alpha alone; from 1/4 to 4. `match` is one of
/// MATCH_LIGHT, MATCH_TRANSMITTANCE and MATCH_SCREEN. Uses the sums up.
/// `positions_due` of a square scene unit of surface, black ones too; 0: not known.
ChannelValues picture_fit(const PictureChart& chart, PictureCells& cells, int match, double positions_due);

/// Memory that it takes beside the sums at its peak, bytes.
std::int64_t picture_fit_bytes(const PictureChart& chart);

}  // namespace astrosplat
