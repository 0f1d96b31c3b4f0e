// Whether a block shows anything is found out once for a look; rendering makes only the blocks that it needs.
#include "streamed/streamed_set.h"

#include <atomic>

#include "core/parallel.h"
#include "look/kernel.h"
#include "look/prepare.h"

namespace astrosplat {
namespace {

constexpr std::int64_t most_samples = 128;  // of a block: 17 MB for 200 million splats

/// The arrays that a thread reads a block into.
SplatSet& block_of_thread() {
    static thread_local SplatSet block;
    return block;
}

/// The rows of a block that are its sample.
std::int64_t sample_row(std::int64_t n, std::int64_t samples, std::int64_t splats) {
    return (2 * n + 1) * splats / (2 * samples);
}

float largest_light_of(const ShadedSplats& splats) {
    float most = 0.0f;
    for (std::size_t i = 0; i < splats.alpha.size(); ++i) {
        const glm::vec3& c = splats.color[i];
        most = std::max(most, splats.alpha[i] * std::max({c.x, c.y, c.z}));
    }
    return most;
}

BlockFacts facts_of(const ShadedSplats& splats) {
    BlockFacts facts;
    glm::vec3 lo(std::numeric_limits<float>::max()), hi(-lo);
    for (const glm::vec3& p : splats.position) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    if (splats.size() > 0) facts.box = {glm::dvec3(lo), glm::dvec3(hi)};
    for (const float radius : splats.radius) facts.radius = std::max(facts.radius, radius);
    facts.splats = splats.size();
    return facts;
}

}  // namespace

std::string why_not_streamed(const NativeBlocks& file, const Look& look) {
    using Match = VerticalAlpha::Match;
    if (file.most_rows() > ShadedBlocks::most_splats) return "its blocks are too large";
    if (file.has(SplatColumn::scale)) return "Gaussians have shapes of their own";
    if (look.vertical.match == Match::picture)
        return "look.vertical.match = \"picture\" needs all splats at once";
    const bool matches = look.vertical.match != Match::none &&
                         (look.vertical.match != Match::automatic || file.facts().generated);
    const bool own_radii =
        look.radius.min == 0.0f && look.radius.max == 0.0f && file.has(SplatColumn::radius);
    if (matches && own_radii) return "look.vertical.match needs the mean of all radii";
    return "";
}

Bounds StreamedSet::bounds() const {
    Bounds box;
    for (std::size_t i = 0; i < file_.size(); ++i) box.add(file_.box(i));
    return box;
}

/// As load_source does for files that do not say it.
void StreamedSet::find_max_distance(const Progress& progress) {
    if (has_max_distance_ || facts_.max_distance > 0.0) return;
    std::atomic<float> largest{0.0f};
    parallel_parts(file_.size(), progress, [&](std::size_t block) {
        SplatSet& set = block_of_thread();
        file_.read(block, {false, false, false, false}, NativeBlocks::Check::none, set);
        const float here = *std::ranges::max_element(set.distance);
        for (float known = largest; here > known && !largest.compare_exchange_weak(known, here);) continue;
    });
    facts_.max_distance = largest;
    has_max_distance_ = true;
}

void StreamedSet::set_look(const Look& look, const LookInputs& inputs, const Progress& progress) {
    blocks_.clear();
    splats_ = 0;
    largest_light_ = 0.0f;
    find_max_distance(progress);
    SplatSet first;
    wanted_ = columns_read(look);
    if (file_.size() > 0) file_.read(0, wanted_, NativeBlocks::Check::none, first);
    static_cast<SplatSetFacts&>(first) = facts_;
    uniforms_ = prepare_look(first, look, inputs);
    map_ = inputs.thickness_map;
    const std::size_t count = file_.size();
    std::vector<BlockFacts> blocks(count + 1);
    std::vector<ShadedSplats> samples(count);
    std::vector<float> light(count, 0.0f);
    parallel_parts(count, progress, [&](std::size_t block) {
        static thread_local ShadedSplats shaded;
        read_and_shade(block, is_checked_ ? NativeBlocks::Check::none : NativeBlocks::Check::all, shaded);
        blocks[block] = facts_of(shaded);
        light[block] = largest_light_of(shaded);
        const std::int64_t samples_here = std::min(most_samples, shaded.size());
        for_each_member([&](auto member) {
            for (std::int64_t n = 0; n < samples_here; ++n)
                (samples[block].*member)
                    .push_back((shaded.*member)[sample_row(n, samples_here, shaded.size())]);
        });
    });
    is_checked_ = true;
    sample_ = {};
    for (std::size_t i = 0; i < count; ++i) {
        blocks[i].first_sample = sample_.size();
        splats_ += blocks[i].splats;
        largest_light_ = std::max(largest_light_, light[i]);
        for_each_member([&](auto member) {
            (sample_.*member)
                .insert((sample_.*member).end(), (samples[i].*member).begin(), (samples[i].*member).end());
        });
    }
    blocks[count].first_sample = sample_.size();
    blocks_ = std::move(blocks);
}

void StreamedSet::read_and_shade(std::size_t block, NativeBlocks::Check check, ShadedSplats& out) const {
    SplatSet& set = block_of_thread();
    file_.read(block, wanted_, check, set);
    for_each_array(out, [&](auto& array) { array.resize(set.position.size()); });
    const LookRun run{LookColumns(set), uniforms_, map_, out};
    const auto kept = std::size_t(shade_run(run, 0, set.size()));
    for_each_array(out, [&](auto& array) { array.resize(kept); });
}

void StreamedSet::shade(std::size_t block, ShadedSplats& out) const {
    read_and_shade(block, NativeBlocks::Check::none, out);
}

}  // namespace astrosplat
