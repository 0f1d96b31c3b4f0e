// Looks applied on the card: a set's arrays stay there, and shaded splats never leave it.
#include "core/log.h"
#include "gl/card_parts.h"
#include "splats/splat_set.h"

namespace astrosplat {

using namespace card;

/// The arrays that this look reads, uploaded where they are not there yet. False: there is no memory for
/// them.
bool Card::keep_set(const SplatSet& set, const LookUniforms& look, bool with_uv, KeptSet& kept) {
    const std::int64_t n = set.size();
    const auto put = [&](std::size_t array, const auto& values) {
        CardBuffer& buffer = kept.arrays[array];
        if (buffer.bytes() > 0) return true;
        const auto bytes = n * std::int64_t(sizeof values[0]);
        return bytes <= most_bytes_ && make_room(bytes) && send(values.data(), bytes, buffer);
    };
    return put(0, set.position) && put(1, set.color) && put(2, set.alpha) && put(3, set.distance) &&
           put(4, set.id) && (!look.radius.own || put(5, set.radius)) && (!with_uv || put(6, set.uv));
}

std::optional<DeviceLook> Card::shade(const SplatSet& set, std::uint64_t set_stamp, const PreparedLook& look,
                                      const Image* map, std::uint64_t stamp) try {
    if (lost_ || set.size() == 0 || !look.outlines.empty()) return {};
    const bool with_map = look.stop_count > 1;
    KeptSet& raw = sets_[set_stamp];
    raw.frame = frames_ + 1;  // which is about to be drawn
    // Looks follow one another: the last one's arrays are the next one's.
    const auto last =
        std::ranges::find_if(kept_, [&](const auto& k) { return k.second.set_stamp == set_stamp; });
    Kept made;
    if (last != kept_.end()) made = std::move(kept_.extract(last).mapped());
    auto& [positions, radii, alphas, colors, ids] = made.arrays;
    made.set_stamp = set_stamp;
    made.frame = frames_ + 1;
    const std::int64_t n = set.size();
    const GLuint none[4] = {};
    GLuint totals[3] = {};
    const Image no_map = make_image(1, 1, 3);
    const Image& texels = with_map ? *map : no_map;
    const bool fits =
        keep_set(set, look, with_map, raw) &&
        make_room(32 * n - positions.bytes() - radii.bytes() - alphas.bytes() - colors.bytes()) &&
        positions.reserve(12 * n) && radii.reserve(4 * n) && alphas.reserve(4 * n) &&
        colors.reserve(12 * n) &&
        look_uniforms_.fill(static_cast<const LookUniforms*>(&look), sizeof(LookUniforms)) &&
        look_map_.fill(texels.pixels.data(), 4 * std::ssize(texels.pixels)) &&
        look_totals_.fill(none, sizeof none);
    if (!fits) {
        sets_.erase(set_stamp);
        return {};
    }
    const GlProgram& p = program("card_look.glsl", "");
    const Uniforms to{p.name()};
    to("splats", static_cast<GLuint>(n));
    glProgramUniform3i(p.name(), to.at("map_size"), int(texels.width), int(texels.height),
                       int(texels.channels));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, look_uniforms_.name());
    const auto& a = raw.arrays;
    bind({&a[0], &a[1], &a[2], &a[3], &a[4], look.radius.own ? &a[5] : &a[3], with_map ? &a[6] : &a[3],
          &look_map_, &positions, &radii, &alphas, &colors, &look_totals_});
    dispatch(p, groups_for(n, group_size));
    glGetNamedBufferSubData(look_totals_.name(), 0, sizeof totals, totals);
    if (glGetError() != GL_NO_ERROR) return {};
    kept_[{stamp, nullptr}] = std::move(made);
    return DeviceLook{totals[0], std::bit_cast<float>(totals[1]), std::bit_cast<float>(totals[2])};
} catch (const Failed& failed) {
    log_warning(failed.what());
    return {};
}

}  // namespace astrosplat
