// Which cells of a chart have a surface under them, and how often. In: a chart and the sums of its cells.
// Out: the sums as if each were covered once.
#pragma once

#include "look/picture_cells.h"
#include "look/picture_chart.h"

namespace astrosplat {

struct PictureCover {
    CellValues inside;  // 1 for cells that have positions or neighbours that have, else 0
    /// How many positions a cell of each block has where the picture is nowhere black, whose black positions
    /// are not in the set; 0: not known.
    std::vector<float> whole;
};

/// Divides the splats' sums by how often their surface is covered: once, unless parts of meshes share u and
/// v, or the set is a sample of one. Empties cells on the edge of a mesh, where all positions beyond it are
/// piled up; they are not inside. `positions_due`: of a square scene unit of surface; 0: not known.
PictureCover cover_once(const PictureChart& chart, PictureCells& cells, double positions_due);

}  // namespace astrosplat
