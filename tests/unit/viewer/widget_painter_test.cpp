// What is drawn anew of a window, against the whole of it.
#include <glad/gl.h>
#include <imgui.h>

#include "core/shared_maths.h"
#include "gl/gl_fixture.h"
#include "support/test.h"
#include "viewer/window.h"

namespace astrosplat {
namespace {

constexpr PixelRect left{0, 0, 10, 10}, middle{20, 0, 30, 10}, right{40, 0, 50, 10};

TEST(ChangedBoxes, AreThoseOfWhatDiffers) {
    const DrawnFrame before{{{left, 1}, {middle, 2}, {right, 3}}, {{left, 4}}};
    EXPECT_TRUE(changed_boxes(before, before).empty());
    DrawnFrame now = before;
    now[0][1] = {{22, 5, 35, 12}, 9};
    EXPECT_EQ(changed_boxes(before, now), (std::vector<PixelRect>{{20, 0, 35, 12}})) << "where it was and is";
    now = before;
    now[0].erase(now[0].begin());
    EXPECT_EQ(changed_boxes(before, now), std::vector<PixelRect>{left});
    EXPECT_EQ(changed_boxes(now, before), std::vector<PixelRect>{left});
    now = before;
    now.push_back({{right, 5}});
    EXPECT_EQ(changed_boxes(before, now), std::vector<PixelRect>{right}) << "a window more";
    now = before;
    std::swap(now[0][0], now[0][2]);
    EXPECT_EQ(changed_boxes(before, now).size(), 3u) << "in another order something else may be on top";
}

TEST(ChangedBoxes, DoNotOverlap) {
    const DrawnFrame now{
        {{{0, 0, 10, 10}, 1}, {{20, 0, 30, 10}, 2}, {{5, 5, 25, 8}, 3}, {{50, 50, 50, 60}, 4}}};
    EXPECT_EQ(changed_boxes({}, now), (std::vector<PixelRect>{{0, 0, 30, 10}}))
        << "one joins two, one is empty";
}

class Painted : public test::GlTest {
  protected:
    static constexpr int width = 220, height = 160, side = 90;

    int number(int below) { return int(uniform(++drawn_, 0) * float(below)); }
    float uniform(std::uint32_t i, std::uint32_t axis) const {
        return shared::as_uniform(shared::as_hash(77u, i, 0u, axis));
    }
    ImU32 color() { return IM_COL32(number(256), number(256), number(256), 60 + number(196)); }

    /// A few things, most of which stay from frame to frame.
    struct Thing {
        int kind, x, y, size;
        ImU32 color;
    };
    Thing thing() { return {number(3), number(width), number(height), 4 + number(40), color()}; }
    static void draw(ImDrawList& list, const Thing& t) {
        const ImVec2 at(float(t.x), float(t.y) + 0.3f * float(t.size % 3));
        if (t.kind == 0) list.AddCircleFilled(at, float(t.size), t.color);
        if (t.kind == 1) list.AddText(at, t.color, "transmittance");
        if (t.kind != 2) return;
        list.PushClipRect({at.x - 5.5f, at.y}, {at.x + float(t.size) + 0.25f, at.y + 9.75f}, true);
        list.AddRectFilled({0, 0}, {float(width), float(height)}, t.color);
        list.PopClipRect();
    }
    void change(std::vector<Thing>& things) {
        if (things.empty() || number(4) == 0) things.push_back(thing());
        if (number(2) == 0) things[std::size_t(number(int(things.size())))] = thing();
        if (things.size() > 6) things.erase(things.begin() + number(int(things.size())));
    }
    void paint_picture() {
        picture_.resize(side, side, GL_RGBA8);
        picture_.bind();
        glClearColor(0.2f, 0.4f, 0.6f, 1.0f);
        glClear(GL_COLOR_BUFFER_BIT);
        glEnable(GL_SCISSOR_TEST);
        glScissor(number(side), number(side), 30, 30);
        glClearColor(uniform(drawn_, 1), uniform(drawn_, 2), uniform(drawn_, 3), 1.0f);
        glClear(GL_COLOR_BUFFER_BIT);
        glDisable(GL_SCISSOR_TEST);
    }

    GlTarget picture_;
    std::uint32_t drawn_ = 0;
};

TEST_F(Painted, PartsMakeTheWhole) {
    WidgetTarget target(width, height);
    std::vector<Thing> below, above;
    int x = 20, y = 30;
    for (int frame = 0; frame < 300; ++frame) {
        SCOPED_TRACE(frame);
        paint_picture();
        if (number(3) == 0) change(below);
        if (number(3) == 0) change(above);
        if (number(20) == 0) x = number(width) - 20, y = number(height) - 20;
        void* const texture = reinterpret_cast<void*>(std::uintptr_t(picture_.texture()));
        target.begin();
        ImDrawList &back = *ImGui::GetBackgroundDrawList(), &front = *ImGui::GetForegroundDrawList();
        for (const Thing& t : below) draw(back, t);
        const ImVec2 corner{float(x), float(y)}, end{float(x + side), float(y + side)};
        back.AddImage(texture, corner, end, {0, 1}, {1, 0});
        if (!above.empty()) draw(back, above[0]);
        for (const Thing& t : above) draw(front, t);
        target.end({texture, side, side});
        WidgetPainter whole;
        whole.paint(width, height, 1, {});
        int columns = 0, rows = 0;
        ASSERT_EQ(target.read(), whole.read(columns, rows));
        ASSERT_EQ(columns, width);
    }
}

}  // namespace
}  // namespace astrosplat
