// Sheets of quads over a rectangle of parameters, and their OBJ files.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace astrosplat::assets {

struct SheetPoint {
    glm::vec3 position;  // scene units
    glm::vec2 uv;
};

struct SheetMesh {
    int columns = 0, rows = 0;       // quads
    std::vector<SheetPoint> points;  // (columns + 1) * (rows + 1), row by row; the last column closes a ring
};

/// Points at (column / columns, row / rows). `ring` says that the first and last column coincide, which
/// make_sheet then does exactly: the last takes the first's position (and its own uv).
SheetMesh make_sheet(int columns, int rows, bool ring,
                     const std::function<SheetPoint(float column, float row)>& point);

/// Quads, three decimals; the first line says what it is.
void save_obj(const SheetMesh& mesh, const std::filesystem::path& file, const std::string& what);

}  // namespace astrosplat::assets
