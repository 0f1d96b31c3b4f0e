// Stored looks: what they bring back, what they leave.
#include "edit/snapshots.h"

#include <gtest/gtest.h>

#include "edit/keyframes.h"
#include "edit/layers.h"
#include "scenes.h"

namespace astrosplat {
namespace {

using test::opacity;

const std::string power = "layer.dust.look.alpha.power";

struct Snapshots : testing::Test {
    test::SceneFolder f;
    Document document = Document::open(f.file);
    StoredLook first = store_look("Erster Blick", document, 1.0);
};

TEST_F(Snapshots, HoldTheMoment) {
    const StoredLook later = store_look("Later", document, 12.0);
    document.set(opacity, 0.25, 1.0);
    EXPECT_EQ(later.name, "Later");
    EXPECT_EQ(later.frame, 12.0);
    EXPECT_EQ(*later.scene, load_scene(f.file));
}

TEST_F(Snapshots, RestoreIsOneStepThatBringsTheLookBack) {
    const Scene before = document.scene();
    document.set(opacity, 0.25, 1.0);
    document.set(power, 5.0, 1.0);
    document.set("layer.dust.visible", false, 1.0);
    document.set("output.exposure", 2.0, 1.0);
    document.edit("Keyframes", [](Scene& s) { set_keyframe(s, power, 3.0, 4.0); });
    document.edit("Keyframes", [](Scene& s) { remove_track(s, "layer.stars.render.core"); });
    restore_look(document, first);
    Scene restored = document.scene();
    EXPECT_EQ(restored.layers, before.layers);
    EXPECT_EQ(restored.output.exposure, 0.0);
    EXPECT_FALSE(is_animated(restored, power));
    EXPECT_EQ(*find_track(restored, "layer.stars.render.core"),
              *find_track(before, "layer.stars.render.core"));
    EXPECT_EQ(document.undo_name(), "Restore Erster Blick");
    document.undo();
    EXPECT_EQ(test::value_of(document, power), Value(5.0));
    document.save();
    EXPECT_EQ(load_scene(f.file), document.scene());
}

TEST_F(Snapshots, WhatIsNoLookStays) {
    document.set("camera.fov", 20.0, 1.0);
    document.set("layer.dust.source.count", std::int64_t{5000}, 1.0);
    document.set("layer.stars.transform.scale", 3.0, 1.0);
    document.set("output.frames", "7", 1.0);
    document.edit("Keyframes", [](Scene& s) { set_keyframe(s, "camera.fov", 3.0, 30.0); });
    const Scene before = document.scene();
    restore_look(document, first);
    EXPECT_EQ(document.scene(), before);
}

TEST_F(Snapshots, LayersAreMatchedByName) {
    document.edit("Layers", [](Scene& s) {
        duplicate_layer(s, 1);
        move_layer(s, 0, 2);
        rename_layer(s, 2, "gas");
        for (LayerParams& layer : s.layers) layer.look.density = 0.125f;
    });
    restore_look(document, first);
    Scene scene = document.scene();
    EXPECT_EQ(test::layer(scene, "stars").look.density, 1.0f);
    EXPECT_EQ(test::layer(scene, "stars_2").look.density, 0.125f);
    EXPECT_EQ(test::layer(scene, "gas").look.density, 0.125f);
    EXPECT_TRUE(is_animated(scene, "layer.gas.look.noise.1.jitter"));
    EXPECT_FALSE(is_animated(scene, "layer.dust.look.noise.1.jitter"));
}

}  // namespace
}  // namespace astrosplat
