#include "support/read_vdb.h"

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

namespace astrosplat::test {
namespace {

std::array<double, 3> array_of(const openvdb::Vec3d& v) { return {v.x(), v.y(), v.z()}; }

template <class Grid, class Convert>
void take_voxels(const openvdb::GridBase::Ptr& base, VdbGrid& out, const Convert& convert) {
    const auto grid = openvdb::gridPtrCast<Grid>(base);
    if (!grid) return;
    for (auto value = grid->cbeginValueOn(); value; ++value) {
        const openvdb::Coord at = value.getCoord();
        out.voxels.push_back({{at.x(), at.y(), at.z()}, convert(*value)});
    }
}

}  // namespace

VdbFile read_vdb(const std::string& file) {
    openvdb::initialize();
    openvdb::io::File in(file);
    in.open();
    VdbFile out;
    const openvdb::MetaMap::Ptr words = in.getMetadata();
    for (auto word = words->beginMeta(); word != words->endMeta(); ++word)
        out.words[word->first] = word->second->str();
    for (auto name = in.beginName(); name != in.endName(); ++name) {
        const openvdb::GridBase::Ptr base = in.readGrid(*name);
        VdbGrid grid;
        grid.type = base->type();
        grid.grid_class = openvdb::GridBase::gridClassToString(base->getGridClass());
        const openvdb::Vec3d origin = base->indexToWorld(openvdb::Coord(0, 0, 0));
        grid.origin = array_of(origin);
        grid.step = array_of(base->indexToWorld(openvdb::Coord(1, 1, 1)) - origin);
        take_voxels<openvdb::FloatGrid>(base, grid, [](float v) { return std::array<float, 3>{v, v, v}; });
        take_voxels<openvdb::Vec3SGrid>(base, grid, [](const openvdb::Vec3s& v) {
            return std::array<float, 3>{v.x(), v.y(), v.z()};
        });
        out.grids[*name] = std::move(grid);
    }
    return out;
}

}  // namespace astrosplat::test
