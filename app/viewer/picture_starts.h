// First scenes of pictures, made in the background: that of the one that is opened or made again, and small
// views of what else it may be. In: a picture and choices. Out: the scene's text, and images.
#pragma once

#include "core/image.h"
#include "edit/document.h"
#include "edit/picture_start.h"
#include "viewer/background_work.h"

namespace astrosplat {

/// A scene that is to be made; `number`: another for each that is asked for.
struct StartRequest {
    PictureStart start;
    std::string choice;  // of Command::start_again; empty: the picture is opened
    fs::path place;      // of the scene
    std::vector<Assignment> assignments = {};
    std::uint64_t revision = 0;  // of the document that was open then
    std::uint64_t number = 0;
    std::shared_ptr<std::atomic<float>> done = std::make_shared<std::atomic<float>>(0.0f);  // 0..1
    bool operator==(const StartRequest& other) const { return number == other.number; }
};

struct StartMade {
    PictureStart start;
    std::string text;   // of the scene
    std::string error;  // one line
};

LatestWork<StartRequest, StartMade>::Work start_maker(const SetCache& cache);

/// The scene that is being made, and those that were, which undo may bring back.
class PictureStarts {
  public:
    explicit PictureStarts(const SetCache& cache) : work_(start_maker(cache)) {}

    /// In place of one that is under way. Returns at once.
    void want(StartRequest request);
    void cancel();
    /// Null: nothing is made.
    const StartRequest* wanted() const { return wanted_ ? &*wanted_ : nullptr; }
    /// Once, when it is made.
    std::shared_ptr<const StartMade> take();

    /// A document began with that.
    void keep(const Document& document, const PictureStart& start);
    /// What the document began with; null: it is not known.
    const PictureStart* of(const Document& document) const;

  private:
    struct Kept {
        std::shared_ptr<const std::string> text;
        PictureStart start;
    };

    std::optional<StartRequest> wanted_;
    std::uint64_t asked_ = 0;
    std::vector<Kept> kept_;  // oldest first
    LatestWork<StartRequest, StartMade> work_;
};

struct KindKey {
    fs::path picture;
    SkyObject object = SkyObject::galaxy;
    auto operator<=>(const KindKey&) const = default;
};

struct KindView {
    Image image;        // display values, RGBA, opaque
    std::string error;  // one line
    std::size_t bytes() const { return image.pixels.size() * sizeof(float); }
};

/// The picture as that kind, from aside, as the window shows frames. Throws InputError, Cancelled.
KindView kind_view(const KindKey& key, const Progress& progress);

/// One after the other, the first one first.
class KindViews : public ReadAhead<KindKey, KindView> {
  public:
    KindViews() : ReadAhead(kind_view, std::size_t{4} << 20) {}
};

}  // namespace astrosplat
