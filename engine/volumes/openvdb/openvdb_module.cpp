#include "volumes/openvdb_file.h"

#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>

#include <sstream>

namespace astrosplat {
namespace {

/// Grids into any stream that seeks: readers find each without reading the others.
struct StreamArchive : openvdb::io::Archive {
    void write_all(std::ostream& out, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& words) {
        write(out, grids, true, words);
    }
};

template <class Grid, class Value, class Convert>
typename Grid::Ptr grid_of(const VoxelGrid& voxels, const Buffer<Value>& values, const Convert& convert) {
    const auto grid = Grid::create();
    for (std::size_t b = 0; b < voxels.blocks.size(); ++b) {
        const Value* block = values.data() + b * block_voxels;
        const glm::ivec3 place = block_side * voxels.blocks[b];
        typename Grid::TreeType::LeafNodeType* leaf = nullptr;
        for (int i = 0; i < block_voxels; ++i) {
            if (block[i] == Value(0.0f)) continue;
            if (!leaf) leaf = grid->tree().touchLeaf({place.x, place.y, place.z});
            leaf->setValueOn(static_cast<openvdb::Index>(i), convert(block[i]));
        }
    }
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxels.voxel_size));
    return grid;
}

openvdb::Vec3SGrid::Ptr vectors_of(const VoxelGrid& voxels, const Buffer<glm::vec3>& values,
                                   const char* name) {
    const auto grid = grid_of<openvdb::Vec3SGrid>(
        voxels, values, [](const glm::vec3& v) { return openvdb::Vec3s(v.x, v.y, v.z); });
    grid->setName(name);
    grid->setVectorType(openvdb::VEC_INVARIANT);
    return grid;
}

std::string bytes_of(const VoxelGrid& voxels, const VolumeWords& words) {
    openvdb::initialize();
    const auto density = grid_of<openvdb::FloatGrid>(voxels, voxels.density, [](float v) { return v; });
    density->setName("density");
    density->setGridClass(openvdb::GRID_FOG_VOLUME);
    const openvdb::GridCPtrVec grids = {density, vectors_of(voxels, voxels.emission, "emission"),
                                        vectors_of(voxels, voxels.color, "Cd")};
    openvdb::MetaMap file_words;
    for (const auto& [key, value] : words) file_words.insertMeta(key, openvdb::StringMetadata(value));
    std::ostringstream out(std::ios::binary);
    StreamArchive().write_all(out, grids, file_words);
    return std::move(out).str();
}

}  // namespace
}  // namespace astrosplat

extern "C" bool astrosplat_openvdb_bytes(const astrosplat::VoxelGrid& grid,
                                         const astrosplat::VolumeWords& words, std::string& bytes) {
    try {
        bytes = astrosplat::bytes_of(grid, words);
        return true;
    } catch (const std::exception& error) {
        bytes = error.what();
        return false;
    }
}
