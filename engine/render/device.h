// A graphics card as the renderer sees it. It projects and folds a blend group with the bits of project() and
// fold(); what lies behind and between the groups stays the processor's. app/gl has one.
#pragma once

#include "core/image.h"
#include "render/render.h"

namespace astrosplat {

struct FrameJob;
class LookDevice;

/// The device asked to draw: a card where there is one that has the processor's bits, or one of the two.
enum class DeviceChoice { automatic, cpu, gpu };

/// A blend group over the region, as TilePlanes holds it of a tile. Four channels each, rows from the top.
struct GroupPlanes {
    Image light;                     // r, g, b, alpha
    Image through;                   // transmittance r, g, b, alpha; empty where `alone` was asked for
    Image more;                      // held, depth sum, uncovered, count; the same
    std::vector<Image> layer_light;  // with RenderSettings::aov_layers, of all layers
    std::int64_t splats = 0;         // that touch the region
    double footprint_px = 0.0;       // sum of their footprints' areas, square px; to a thirtieth each
};

class RenderDevice {
  public:
    virtual ~RenderDevice() = default;
    /// "NVIDIA H100"
    virtual std::string name() const = 0;
    /// Bytes of its memory that no one has taken; 0: its driver does not say.
    virtual std::int64_t free_bytes() const { return 0; }
    /// What applies looks in its memory; null: it cannot.
    virtual LookDevice* looks() { return nullptr; }
    /// Why the processor has to draw this frame, "it ..."; empty: the card can. The job is prepared.
    virtual std::string cannot(const FrameJob& job) const = 0;
    /// Draws a group of a job that it can; `alone`: its light, alpha within 0 and 1, is the frame. Null where
    /// the card has not the memory or is lost, or finds that it cannot. Throws Cancelled.
    virtual std::optional<GroupPlanes> draw(const FrameJob& job, std::size_t group, bool alone) = 0;
};

/// The groups of a frame as its settings' device has drawn them; where `alone` the light of the first
/// is the frame.
struct DrawnGroups {
    std::vector<GroupPlanes> planes;
    bool alone = false;
};
/// None where the processor has to draw, with the reason in `statistics`.
std::optional<DrawnGroups> draw_on_device(const FrameJob& job, RenderCache::State& cache,
                                          RenderStatistics& statistics);
/// Composites them into the frame, whose beauty is empty where they stand alone.
void resolve_drawn(const FrameJob& job, DrawnGroups groups, RenderedFrame& frame);

}  // namespace astrosplat
