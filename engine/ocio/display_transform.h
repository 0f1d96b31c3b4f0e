// Colour management by OpenColorIO. In: the names of a configuration, a display and a view. Out: what turns
// the program's scene light into that display's numbers, on the processor and as GLSL; what a configuration
// has to choose from; and all that it depends on, for the frame hash.
#pragma once

#include "core/error.h"

namespace astrosplat {

/// [output] ocio. Unless wanted(), a view is the program's own.
struct OcioParams {
    fs::path config;            // empty: the file that the environment's OCIO names
    std::string display, view;  // empty: the configuration's first
    std::string space;          // the configuration's name for linear light of Rec. 709; empty: looked for
    bool wanted() const { return !config.empty() || !display.empty() || !view.empty() || !space.empty(); }
    bool operator==(const OcioParams&) const = default;
};

/// A fault of one of these parameters; what() begins with the whole key.
struct OcioError : InputError {
    OcioError(std::string key, const std::string& message);
    std::string key;  // "output.ocio.display"
};

/// The choices that a configuration offers.
struct ColorDisplay {
    std::string name;
    std::vector<std::string> views;
    std::string default_view;
};
struct ColorConfig {
    fs::path file;
    std::vector<ColorDisplay> displays;
    std::string default_display;
};

/// The file that `params` or else the environment's OCIO names; may be empty.
fs::path config_file(const OcioParams& params);

/// Throws InputError where there is no such file or it is no configuration.
ColorConfig read_color_config(const fs::path& file);

/// A table that the text reads by a sampler of this name.
struct GlslTable {
    std::string sampler;
    int dimensions = 1;         // of the texture: 1, 2 or 3
    int width = 1, height = 1;  // texels; a cube has `width` on each side
    int channels = 3;           // 1 or 3
    bool smooth = true;         // interpolated linearly by the sampler
    std::vector<float> values;  // x fastest
};

struct GlslTransform {
    std::string text;  // of "vec4 ocio_display(vec4)", GLSL 4.0
    std::vector<GlslTable> tables;
};

/// Scene light (linear, primaries of Rec. 709) to one view of one display. Threads may share it.
class DisplayTransform {
  public:
    /// Throws OcioError, InputError.
    explicit DisplayTransform(const OcioParams& params);
    ~DisplayTransform();
    DisplayTransform(const DisplayTransform&) = delete;
    DisplayTransform& operator=(const DisplayTransform&) = delete;

    /// r, g, b of `pixels` pixels side by side: linear light in, display values from 0 to 1 out; NaN gives 0.
    void apply(float* rgb, std::int64_t pixels) const;
    /// The same for a fragment shader, without the limits.
    GlslTransform glsl() const;
    /// The names in use.
    const std::string& display() const;
    const std::string& view() const;
    const std::string& space() const;
    /// The configuration, and the tables it reads for this view.
    const std::vector<fs::path>& files() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// One that was made before, as long as its files stay as they are. Throws OcioError, InputError.
std::shared_ptr<const DisplayTransform> display_transform(const OcioParams& params);

/// Of the library, such as "2.1.2".
std::string ocio_version();

}  // namespace astrosplat
