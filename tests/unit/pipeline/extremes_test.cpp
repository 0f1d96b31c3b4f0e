// Whatever a description allows gives a picture of finite numbers, or one line that says why not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/error.h"
#include "pipeline.h"
#include "scene/describe.h"
#include "sets/load_source.h"
#include "support/frames.h"
#include "support/quiet.h"
#include "support/small_scene.h"

namespace astrosplat {
namespace {

bool is_finite(const Image& image) {
    return std::all_of(image.pixels.begin(), image.pixels.end(), [](float x) { return std::isfinite(x); });
}

class Extremes : public testing::Test {
  protected:
    Extremes() {
        Scene& scene = small.scene;
        scene.output.width = 32;
        scene.output.height = 20;
        scene.output.aovs = {"depth", "coverage", "count", "layers"};
        for (LayerParams& layer : scene.layers) {
            layer.source.count = 100;
            layer.look.noise = {Noise()};
            layer.look.noise[0].jitter = 0.1f;
            sets.push_back(std::make_shared<const SplatSet>(load_source(layer.source, layer.name)));
        }
    }

    void expect_finite(const Scene& scene, const std::string& what) {
        try {
            Pipeline pipeline;
            pipeline.set_scene(scene, sets);
            const RenderedFrame frame = frame_of(pipeline, 1.0);
            EXPECT_TRUE(is_finite(frame.beauty)) << what;
            EXPECT_TRUE(is_finite(frame.depth)) << what;
            for (const Image& layer : frame.layers) EXPECT_TRUE(is_finite(layer)) << what;
        } catch (const InputError&) {
            // one line with the reason
        } catch (const std::exception& error) {
            ADD_FAILURE() << what << ": " << error.what();
        }
    }

    Quiet quiet;
    SmallScene small;
    std::vector<std::shared_ptr<const SplatSet>> sets;
};

Value all_components(const ParameterSpec& spec, double x) {
    if (spec.type == ParameterType::integer) return static_cast<std::int64_t>(x);
    if (spec.components == 1) return x;
    return Value::List(static_cast<std::size_t>(spec.components), Value(x));
}

TEST_F(Extremes, BothEndsOfEveryRangeGiveFinitePictures) {
    Scene original = small.scene;
    int tried = 0;
    for (std::size_t i = 0; i < describe(original).parameters.size(); ++i) {
        Scene scene = original;
        const Parameter parameter = describe(scene).parameters.at(i);
        const ParameterSpec& spec = parameter.spec;
        const bool is_size = spec.key.is_below("output") || spec.generic_key.is_below("layer.source");
        if (!is_numeric(spec.type) || spec.type == ParameterType::curve || is_size) continue;
        const double end = spec.below_max ? std::nextafter(spec.max, 0.0) : spec.max;
        for (const double x : {spec.min, end, std::max(spec.min, 1e-30)}) {
            try {
                parameter.set(all_components(spec, x));
            } catch (const ValueError&) {
                continue;  // the float below 1 is 1
            }
            expect_finite(scene, spec.key.text() + " = " + short_number(x));
            ++tried;
        }
    }
    EXPECT_GT(tried, 150);
}

TEST_F(Extremes, SplatsTooFarOutNameTheirLayer) {
    SplatSet far_out = *sets[1];
    far_out.position[7].y = 1e20f;
    sets[1] = std::make_shared<const SplatSet>(std::move(far_out));
    Pipeline pipeline;
    try {
        pipeline.set_scene(small.scene, sets);
        FAIL() << "expected an InputError";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "layer.dust: expected splats within 1e+12 scene units of 0, found one at 1e+20");
    }
}

TEST_F(Extremes, SplatsThatTheirTransformPutsTooFarOutNameTheirLayer) {
    SplatSet far_out = *sets[1];
    far_out.position[7].y = 1e8f;
    sets[1] = std::make_shared<const SplatSet>(std::move(far_out));
    Pipeline pipeline;
    pipeline.set_scene(small.scene, sets);
    EXPECT_NO_THROW(frame_of(pipeline, 1.0));
    small.scene.layers[1].transform.scale = 1e9;
    pipeline.set_scene(small.scene, sets);
    try {
        frame_of(pipeline, 1.0);
        FAIL() << "expected an InputError";
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find("layer.dust: expected splats within 1e+15 scene units of 0"),
                  0u)
            << error.what();
    }
}

}  // namespace
}  // namespace astrosplat
