#include "support/preview_views.h"

#include <chrono>
#include <thread>

#include "core/error.h"
#include "core/progress.h"
#include "support/temp_folder.h"
#include "viewer/session.h"

namespace astrosplat::test {
namespace {

constexpr int frame_width = 960, frame_height = 540;
constexpr std::int64_t block_px = 64;

FreeCamera camera_at(const glm::dvec3& position, const glm::dvec3& pivot = glm::dvec3(0.0),
                     const glm::dvec3& up = {0.0, 1.0, 0.0}) {
    FreeCamera camera;
    camera.position = position;
    camera.pivot = pivot;
    camera.up = up;
    camera.fov_deg = 40.0;
    return camera;
}

constexpr const char* picture_on_a_plane =
    "astrosplat = 1\n[[layer]]\nname = \"picture\"\n[layer.source]\n"
    "meshes = [ { mesh = \"plane\", texture = \"" ASTROSPLAT_SOURCE_DIR
    "/assets/textures/butterfly.jpg\" } ]\n"
    "max_distance = 0.15\n";

/// Light of a part of the picture, Rec. 709.
double brightness(const Image& image, const Region& part) {
    double sum = 0.0;
    for (std::int64_t y = part.y; y < part.y + part.height; ++y)
        for (std::int64_t x = part.x; x < part.x + part.width; ++x) {
            const float* p = image.at(x, y);
            sum += 0.2126 * double(p[0]) + 0.7152 * double(p[1]) + 0.0722 * double(p[2]);
        }
    return sum / double(part.width * part.height);
}

std::vector<double> block_brightness(const Image& image) {
    std::vector<double> blocks;
    for (std::int64_t y = 0; y + block_px <= image.height; y += block_px)
        for (std::int64_t x = 0; x + block_px <= image.width; x += block_px)
            blocks.push_back(brightness(image, {x, y, block_px, block_px}));
    return blocks;
}

/// Rows between the halves of the brightest row's light, above and below it.
double thickness(const Image& image) {
    std::vector<double> rows;
    for (std::int64_t y = 0; y < image.height; ++y) rows.push_back(brightness(image, {0, y, image.width, 1}));
    const auto middle = std::max_element(rows.begin(), rows.end()) - rows.begin();
    const double half = 0.5 * rows[middle];
    const auto edge = [&](std::ptrdiff_t step) {
        std::ptrdiff_t y = middle;
        const auto last = std::ptrdiff_t(rows.size()) - 1;
        while (y > 0 && y < last && rows[y] > half) y += step;
        return std::fabs(double(y - middle)) - (half - rows[y]) / (rows[y - step] - rows[y]);
    };
    return edge(1) + edge(-1);
}

/// Draws until `done`, as the window does while it is left alone.
template <class Done>
void draw_until(Session& session, const Done& done) {
    for (;;) {
        const double now = seconds_now();
        advance(session, now);
        draw_viewport(session, {frame_width, frame_height}, now, true);
        if (session.status.view_frame.state == ViewFrameState::failed)
            throw InputError(session.status.view_frame.error);
        if (session.sets.loaded(session.document) && done()) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
}

}  // namespace

std::span<const NamedView> preview_views() {
    static const NamedView views[] = {
        {"galaxy from the front", "whirlpool.toml", camera_at({0, 13, 0}, {}, {0, 0, -1})},
        {"galaxy at an angle", "whirlpool.toml", camera_at({3.0, 6.2, 8.4})},
        {"galaxy from its edge", "whirlpool.toml", camera_at({0, 0, 13}), true},
        {"picture on a plane at an angle", nullptr, camera_at({2.0, 3.5, 9.0})},
        {"nebula from the side", "nebula.toml", camera_at({10.0, 1.0, 1.0})},
        {"nebula inside", "nebula.toml", camera_at({0.9, 0.3, 0.5}, {-1.5, 0.0, -0.5})},
    };
    return views;
}

ViewTruth compare_frames(const Image& preview, const Image& final, bool is_edge) {
    ViewTruth truth;
    const Region all{0, 0, final.width, final.height};
    truth.light = brightness(preview, all) / brightness(final, all);
    const std::vector<double> wanted = block_brightness(final), shown = block_brightness(preview);
    const double brightest = *std::max_element(wanted.begin(), wanted.end());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (wanted[i] < 0.1 * brightest) continue;
        ++truth.bright_blocks;
        truth.near += std::fabs(shown[i] / wanted[i] - 1.0) <= 0.2;
    }
    if (is_edge) truth.thickness = thickness(preview) / thickness(final);
    return truth;
}

ViewTruth measure_truth(const NamedView& view, std::int64_t shown, const SetCache& cache) {
    const TempFolder folder;
    ViewerOptions options;
    options.cache = cache;
    options.input = view.scene ? fs::path(ASTROSPLAT_SOURCE_DIR) / "assets/scenes" / view.scene
                               : folder.file("plane.toml", picture_on_a_plane);
    Session session(options, {});
    session.gl.software = true;
    session.view.view = ViewKind::free;
    session.view.free = view.camera;
    session.fixed_splats = shown;
    session.view.settle = false;
    session.document.edit("No sky", [](Scene& scene) { scene.environment.image.clear(); });
    draw_until(session, [&] { return preview_exact(session); });
    const Image preview = *session.view_frame.pixels();
    const ViewFrameStatus status = session.view_frame.status();
    session.view.settle = true;
    draw_until(session, [&] { return settled(session); });
    ViewTruth truth = compare_frames(preview, *session.view_frame.pixels(), view.is_edge);
    truth.shown = status.shown;
    truth.splats = status.total;
    truth.preview = preview;
    truth.final = *session.view_frame.pixels();
    return truth;
}

namespace {

struct SeenFromSide {
    const char* name;
    glm::dvec3 from, at;  // of the box's half diagonal in its plane
    glm::dvec3 up;
};
constexpr SeenFromSide sides[] = {
    {"front", {0, 2.2, 0}, {}, {0, 0, -1}},
    {"45 degrees off", {0, 1.5, 1.5}, {}, {0, 1, 0}},
    {"aside", {2.1, 0.45, 0.2}, {}, {0, 1, 0}},
    {"from its edge", {0, 0, 2.2}, {}, {0, 1, 0}},
    {"from behind", {0.4, -2.1, 0.5}, {}, {0, 0, -1}},
    {"close by", {0.16, 0.12, 0.2}, {-0.2, 0.0, -0.1}, {0, 1, 0}},
};

}  // namespace

std::vector<CausedView> measure_causes(const std::filesystem::path& scene, std::int64_t shown,
                                       const SetCache& cache) {
    std::vector<CausedView> found;
    std::vector<Image> opened(std::size(sides));
    const auto options = [&] {
        ViewerOptions o;
        o.cache = cache;
        o.input = scene;
        return o;
    };
    glm::dvec3 middle(0.0);
    double size = 0.0;
    const auto look_from = [&](Session& session, const SeenFromSide& side) {
        session.view.view = ViewKind::free;
        session.view.free = camera_at(middle + size * side.from, middle + size * side.at, side.up);
    };
    const auto begin = [&](Session& session) {
        session.gl.software = true;
        session.fixed_splats = shown;
        session.view.settle = false;
        session.document.edit("No sky", [](Scene& s) { s.environment.image.clear(); });
    };
    Session session(options(), {});
    begin(session);
    draw_until(session, [&] { return preview_exact(session); });
    const Bounds box = session.status.box;
    middle = 0.5 * (box.lo + box.hi);
    size = 0.5 * std::max(box.extent().x, box.extent().z);
    for (std::size_t i = 0; i < std::size(sides); ++i) {
        Session fresh(options(), {});
        begin(fresh);
        look_from(fresh, sides[i]);
        while (fresh.status.view_frame.shown == 0 || !fresh.sets.loader().sets_there()) {
            advance(fresh, seconds_now());
            draw_viewport(fresh, {frame_width, frame_height}, seconds_now(), true);
        }
        opened[i] = *fresh.view_frame.pixels();
    }
    const Scene before = session.document.scene();
    for (std::size_t i = 0; i < std::size(sides); ++i) {
        const auto add = [&](Cause cause, const Image& preview, std::int64_t splats) {
            const Image& final = *session.view_frame.pixels();
            ViewTruth truth = compare_frames(preview, final, false);
            truth.shown = splats;
            truth.preview = preview;
            truth.final = final;
            found.push_back({sides[i].name, cause, std::move(truth)});
        };
        look_from(session, sides[i]);
        session.view.settle = false;
        draw_until(session, [&] { return preview_exact(session); });
        const Image moved = *session.view_frame.pixels();
        const std::int64_t splats = session.view_frame.status().shown;
        session.view.settle = true;
        draw_until(session, [&] { return settled(session); });
        add(Cause::opening, opened[i], 0);
        add(Cause::move, moved, splats);
        session.view.settle = false;
        session.document.edit("Look", [&](Scene& s) {
            for (LayerParams& layer : s.layers)
                layer.look.alpha.power = 1.3f * layer.look.alpha.power, layer.look.density = 0.7f;
        });
        draw_viewport(session, {frame_width, frame_height}, seconds_now(), true);
        const Image edited = *session.view_frame.pixels();
        const std::int64_t then = session.view_frame.status().shown;
        session.view.settle = true;
        draw_until(session, [&] { return settled(session); });
        add(Cause::edit, edited, then);
        session.document.edit("Back", [&](Scene& s) { s = before; });
    }
    return found;
}

}  // namespace astrosplat::test
