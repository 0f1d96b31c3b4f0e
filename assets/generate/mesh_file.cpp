// Sheets and their OBJ files, written through fmt so that no locale gets in.
#include "mesh_file.h"

#include <fmt/format.h>

#include <fstream>

#include "core/error.h"

namespace astrosplat::assets {

SheetMesh make_sheet(int columns, int rows, bool ring,
                     const std::function<SheetPoint(float column, float row)>& point) {
    SheetMesh mesh{columns, rows, {}};
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            const float row = static_cast<float>(j) / static_cast<float>(rows);
            mesh.points.push_back(point(static_cast<float>(i) / static_cast<float>(columns), row));
            if (ring && i == columns)
                mesh.points.back().position = mesh.points[mesh.points.size() - 1 - columns].position;
        }
    return mesh;
}

void save_obj(const SheetMesh& mesh, const std::filesystem::path& file, const std::string& what) {
    std::string text = fmt::format("# {}; made by astrosplat_make_assets\n", what);
    for (const SheetPoint& p : mesh.points)
        text += fmt::format("v {:.3f} {:.3f} {:.3f}\n", p.position.x, p.position.y, p.position.z);
    for (const SheetPoint& p : mesh.points) text += fmt::format("vt {:.4f} {:.4f}\n", p.uv.x, p.uv.y);
    for (int j = 0; j < mesh.rows; ++j)
        for (int i = 1; i <= mesh.columns; ++i) {
            const int a = j * (mesh.columns + 1) + i, b = a + 1, d = a + mesh.columns + 1, c = d + 1;
            text += fmt::format("f {0}/{0} {1}/{1} {2}/{2} {3}/{3}\n", a, b, c, d);
        }
    std::ofstream out(file, std::ios::binary);
    out << text;
    if (!out.flush()) throw OutputError(fmt::format("{}: cannot be written", file.string()));
}

}  // namespace astrosplat::assets
