#include "export_volume.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/common.hpp>

#include "core/color.h"
#include "core/memory.h"
#include "core/text.h"
#include "volumes/voxel_grid.h"

namespace astrosplat {
namespace {

struct GridFacts {
    double density = 0.0;  // sums over voxels times their volume: square scene units
    glm::dvec3 emission{0.0};
    std::int64_t active = 0;
    glm::ivec3 lo{0}, hi{0};  // voxels
};

GridFacts facts_of(const VoxelGrid& grid) {
    GridFacts facts;
    facts.lo = glm::ivec3(1 << 30);
    facts.hi = -facts.lo;
    for (std::size_t i = 0; i < grid.density.size(); ++i) {
        if (grid.density[i] == 0.0f && grid.emission[i] == glm::vec3(0.0f)) continue;
        const auto in = static_cast<int>(i % block_voxels);
        const glm::ivec3 voxel =
            block_side * grid.blocks[i / block_voxels] + glm::ivec3(in / 64, in / 8 % 8, in % 8);
        facts.lo = glm::min(facts.lo, voxel);
        facts.hi = glm::max(facts.hi, voxel);
        ++facts.active;
        facts.density += grid.density[i];
        facts.emission += grid.emission[i];
    }
    const double volume = grid.voxel_size * grid.voxel_size * grid.voxel_size;
    facts.density *= volume;
    facts.emission *= volume;
    return facts;
}

double luminance_of(const glm::dvec3& c) { return luminance(float(c.x), float(c.y), float(c.z)); }

double percent_lost(double put, double there) { return put > 0.0 ? 100.0 * (1.0 - there / put) : 0.0; }

void report(const WriteTarget& target, const VoxelGrid& grid, const BakeCounts& counts) {
    const GridFacts facts = facts_of(grid);
    const glm::ivec3 side = facts.hi - facts.lo + 1;
    std::string line = fmt::format(
        "{}: {} x {} x {} voxels of {:.4g}, {} in use; density adds up to {:.4g}, light to {:.4g} square "
        "scene "
        "units; {:.2f} % of the light lost",
        printable(target.file.string()), side.x, side.y, side.z, grid.voxel_size,
        human_count(double(facts.active)), facts.density, luminance_of(facts.emission),
        std::fabs(percent_lost(luminance_of(grid.emission_put), luminance_of(facts.emission))));
    if (facts.density == 0.0) line += "; nothing hides, so density is empty";
    if (counts.dust > 0) line += fmt::format("; {} of dust are grey", counts.dust);
    fmt::print("{}\n", line);
}

}  // namespace

VolumeWords words_about(const FrameScene& frame, const std::string& input_credit) {
    const ProvenanceParams& from = frame.scene.provenance;
    VolumeWords words = {{"creator", std::string("astrosplat ") + ASTROSPLAT_VERSION},
                         {"title", from.title},
                         {"credit", from.credit.empty() ? input_credit : from.credit},
                         {"type", from.type},
                         {"frame", fmt::format("{}", frame.number)},
                         {"exposure_stops", fmt::format("{}", render_settings(frame.scene.output).exposure)},
                         {"density", "extinction per scene unit"},
                         {"emission", "linear light per scene unit, primaries of Rec. 709"},
                         {"Cd", "straight colour: emission / density of what blends over"},
                         {"up", "y"}};
    std::erase_if(words, [](const auto& word) { return word.second.empty(); });
    return words;
}

bool export_volume(const std::vector<RenderLayer>& layers, const Camera& camera, const VolumeExport& volume,
                   const Progress& progress) {
    std::vector<VoxelSplat> splats;
    BakeCounts counts;
    for (const RenderLayer& layer : layers) add_voxel_splats(layer, camera, volume.gain, splats, counts);
    if (splats.empty()) return false;
    const double size = volume.voxel_size > 0.0 ? volume.voxel_size : default_voxel_size(splats);
    const VoxelGrid grid = fill_voxels(splats, size, progress);
    write_openvdb(volume.target, grid, volume.words, progress);
    report(volume.target, grid, counts);
    return true;
}

}  // namespace astrosplat
