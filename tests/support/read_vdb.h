// The grids of a file as OpenVDB itself reads them. In: a path. Out: its grids' values, places and names.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

namespace astrosplat::test {

struct VdbGrid {
    std::string type, grid_class;
    std::array<double, 3> origin{}, step{};  // world places of voxel (0, 0, 0), and of (1, 1, 1) from there
    struct Voxel {
        std::array<int, 3> index;
        std::array<float, 3> value;  // of a float grid: three times the same
    };
    std::vector<Voxel> voxels;  // those in use
};

struct VdbFile {
    std::map<std::string, VdbGrid> grids;
    std::map<std::string, std::string> words;
};

/// Throws openvdb::Exception.
VdbFile read_vdb(const std::string& file);

}  // namespace astrosplat::test
