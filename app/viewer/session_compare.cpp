// Session: snapshots, and what the picture is compared with.
#include <algorithm>
#include <cmath>

#include "core/color.h"
#include "core/error.h"
#include "scene/animate.h"
#include "source/texture.h"
#include "viewer/session_impl.h"

namespace astrosplat {
namespace {

/// An 8-bit picture (RGBA, top row first) as a float one of at most `width` px, by averaging boxes.
Image shrink(const std::vector<unsigned char>& rgba, int width, int height, int most) {
    const int factor = std::max(1, (width + most - 1) / most);
    Image small = make_image(std::max(1, width / factor), std::max(1, height / factor), 4, 0.0f);
    for (std::int64_t y = 0; y < small.height; ++y)
        for (std::int64_t x = 0; x < small.width; ++x)
            for (int c = 0; c < 4; ++c) {
                int sum = 0;
                for (int j = 0; j < factor; ++j)
                    for (int i = 0; i < factor; ++i)
                        sum += rgba[static_cast<std::size_t>(((y * factor + j) * width + x * factor + i) * 4 +
                                                             c)];
                small.at(x, y)[c] = static_cast<float>(sum) / (255.0f * static_cast<float>(factor * factor));
            }
    return small;
}

}  // namespace

void Session::Impl::take_snapshot() {
    constexpr std::size_t most = 24;
    StoredPicture stored;
    stored.look = store_look("Look " + std::to_string(++snapshots_taken), document, view);
    const std::vector<unsigned char> pixels = display.read();
    const Image small = shrink(pixels, viewport_width, viewport_height, 192);
    stored.thumbnail.upload(small);
    stored.aspect = static_cast<float>(small.width) / static_cast<float>(small.height);
    stored.splats = a.status().state == PictureState::final ? a.status().total : a.status().shown;
    stored.seconds = a.status().state == PictureState::final ? a.status().seconds : 0.0;
    snapshots.push_back(std::move(stored));
    if (snapshots.size() > most) delete_snapshot(0);
}

void Session::Impl::delete_snapshot(std::size_t index) {
    if (index >= snapshots.size()) return;
    snapshots.erase(snapshots.begin() + static_cast<std::ptrdiff_t>(index));
    if (b_snapshot == static_cast<int>(index)) b_snapshot = -1;
    if (b_snapshot > static_cast<int>(index)) --b_snapshot;
}

void Session::Impl::load_reference() {
    if (view.reference == reference_file) return;
    reference_file = view.reference;
    const Image raw = load_raw_image(reference_file);  // display values, as the file has them
    Image rgba = make_image(raw.width, raw.height, 4, 1.0f);
    for (std::int64_t y = 0; y < raw.height; ++y)
        for (std::int64_t x = 0; x < raw.width; ++x)
            for (int c = 0; c < 3; ++c)
                rgba.at(x, y)[c] = raw.at(x, y)[std::min(c, raw.channels >= 3 ? 2 : 0)];
    reference.upload(rgba);
    ++references_loaded;
}

/// Puts B beside A: the look of a snapshot with the same camera, or the reference picture.
void Session::Impl::show_comparison(DisplaySettings& shown, const PreviewChoice& choice, bool may_settle,
                                    double now) {
    using Mode = DisplaySettings::Mode;
    comparing = view.compare != CompareMode::a;
    if (!comparing) return;
    const bool with_reference =
        view.compare == CompareMode::reference ||
        (view.compare == CompareMode::difference && b_snapshot < 0 && reference.handle() != 0);
    if (with_reference) {
        if (reference.handle() == 0) return;
        shown.b = reference.handle();
        shown.b_is_display = true;
    } else {
        if (b_snapshot < 0) return;
        const StoredLook& look = snapshots[static_cast<std::size_t>(b_snapshot)].look;
        PictureRequest wanted = make_request(evaluated(with_look_of(document.scene(), *look.scene)));
        wanted.region = request.region;
        // A's final picture comes first; B's follows it.
        const bool a_is_done =
            a.status().state == PictureState::final || a.status().state == PictureState::failed;
        b.show(wanted, choice, may_settle && a_is_done, now);
        shown.b = b.texture();
    }
    shown.mode = view.compare == CompareMode::b            ? Mode::b
                 : view.compare == CompareMode::difference ? Mode::difference
                                                           : Mode::wipe;
    shown.difference_gain = view.difference_gain;
}

}  // namespace astrosplat
