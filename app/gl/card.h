// The renderer on a graphics card: compute shaders that give the bits of engine/render's fold. Splats stay in
// the card's memory between frames; each frame they are projected, put in order of depth, entered into tiles
// of 16 x 16 px and folded there. Which pass does what: shaders/card_*.glsl. Slabs of depth, each at most
// some 256 MB of records, because random reads over more than the card's address translation reaches are
// a hundred times slower (an H100 beyond 512 MB). Where the memory is short, slabs come one after the other
// and share their buffers, then bands of the frame.
#pragma once

#include <array>
#include <map>

#include "gl/objects.h"
#include "look/device.h"
#include "render/device.h"
#include "render/frame_job.h"

namespace astrosplat {

/// Memory on the card; grows, and keeps nothing when it does.
class CardBuffer {
  public:
    /// At least so many bytes. False where the card has not so much.
    bool reserve(std::int64_t bytes, GLbitfield flags = GL_DYNAMIC_STORAGE_BIT);
    /// Reserves, and copies there.
    bool fill(const void* data, std::int64_t bytes);
    void release() { *this = {}; }
    void bind(GLuint at) const { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, at, buffer_.name()); }
    GLuint name() const { return buffer_.name(); }
    std::int64_t bytes() const { return bytes_; }

  private:
    GlBuffer buffer_;
    std::int64_t bytes_ = 0;
};

/// Sets uniforms of a program by name.
struct Uniforms {
    GLuint program;
    void operator()(const char* name, int v) const { glProgramUniform1i(program, at(name), v); }
    void operator()(const char* name, GLuint v) const { glProgramUniform1ui(program, at(name), v); }
    void operator()(const char* name, float v) const { glProgramUniform1f(program, at(name), v); }
    GLint at(const char* name) const { return glGetUniformLocation(program, name); }
};

class Card final : public RenderDevice, public LookDevice {
  public:
    /// Of the current context, which has to be current in all calls. `native_division`: the driver's own
    /// division and square root have IEEE 754's bits. Throws NoContext where it cannot compute.
    explicit Card(const GlInfo& info, bool native_division);

    std::string name() const override { return info_.renderer; }
    std::int64_t free_bytes() const override;
    std::string cannot(const FrameJob& job) const override;
    std::optional<GroupPlanes> draw(const FrameJob& job, std::size_t group, bool alone) override;
    LookDevice* looks() override { return this; }
    std::optional<DeviceLook> shade(const SplatSet& set, std::uint64_t set_stamp, const PreparedLook& look,
                                    const Image* map, std::uint64_t stamp) override;

    /// Slabs of depth from now on, which change no pixel; 0: as many as suit the memory.
    void set_slabs(int slabs) { slabs_ = slabs; }
    /// Bytes that its buffers may take in all; 0: what the driver says is free.
    void set_room(std::int64_t bytes) { room_ = bytes; }
    /// How much of a frame is in its memory at a time.
    struct Share {
        bool apart = false;      // slabs one after the other
        GLuint slabs = 0;        // 0: as many as suit the memory
        std::int64_t bands = 1;  // of the frame
    };
    /// Of the last group drawn.
    const Share& share() const { return share_; }
    /// For tests: changes the texts of its programs, before the first frame.
    void set_edit(std::function<void(std::string& text)> edit) { edit_ = std::move(edit); }
    /// Milliseconds on the card of the last group drawn, pass by pass.
    struct PassTime {
        const char* name;
        double milliseconds;
    };
    std::vector<PassTime> pass_times() const;
    /// Bytes of all buffers in the card's own memory.
    std::int64_t bytes();

  private:
    struct Kept {
        std::array<CardBuffer, 5> arrays;  // positions, radii, alphas, colours, ids where asked
        const CardBuffer* ids = nullptr;   // where they are
        std::uint64_t frame = 0;           // that used it last
        std::uint64_t set_stamp = 0;       // of the set that a look made them of here; 0: they were uploaded
    };
    struct KeptSet {  // as it is before a look
        std::array<CardBuffer, 7>
            arrays;  // positions, colours, alphas, distances, ids; radii, uv where asked
        std::uint64_t frame = 0;
    };
    struct Splats {  // some of a layer's
        std::size_t layer;
        const Kept* kept;         // that the card projects; null: they are,
        const CardBuffer* given;  // here, from `first_given` on
        std::int64_t count, first_given;
        GLuint first_group, first_rank;  // groups are of 256 splats
    };
    static constexpr GLuint all_slabs = 0xffffffffu;
    struct Group {
        Region region;  // of the frame
        std::vector<Splats> splats;
        std::vector<const FootprintTable*> tables;
        FoldKind kind;
        bool alone, any, screen;     // any: records for any mix; screen: plain records of screens
        bool shaped, ranked;         // some are not round; some layers are projected here and there
        std::int64_t count, pixels;  // of splats
        GLuint splat_groups, slabs;
        GLuint only = all_slabs;  // slab whose records and entries there are
        GLuint listed() const { return only == all_slabs ? slabs : 1; }
        int columns, rows;  // tiles
    };
    static constexpr GLuint most_slabs = 32;
    struct Counts {
        GLuint visible, entries, entries_wanted, entries_room, area_low, area_high, lowest, highest,
            first_key, last_key, entries_low, entries_high, bins[1024], slab_begin[most_slabs + 1];
    };

    Group plan(const FrameJob& job, std::size_t group, bool alone, const Region& region) const;
    GLuint slabs_for(std::int64_t splats, const Share& share) const;
    bool gather(const FrameJob& job, std::size_t number, Group& group);
    bool give(const FrameJob& job, Group& group, std::size_t layer);
    bool make_children(const FrameJob& job, Group& group, std::size_t layer, const Kept& kept);
    void set_children(const GlProgram& program, const FrameJob& job, const Group& group, std::size_t layer);
    bool send(const void* data, std::int64_t bytes, CardBuffer& to);
    const Kept* keep(const RenderLayer& layer, bool with_ids);
    bool keep_set(const SplatSet& set, const LookUniforms& look, bool with_uv, KeptSet& kept);
    bool make_room(std::int64_t bytes_more);
    bool upload_tables(const FrameJob& job, const Group& group);
    std::int64_t room();
    void clear_layers(const FrameJob& job);
    std::vector<CardBuffer*> working();
    bool reserve(const FrameJob& job, const Group& group, std::int64_t records, std::int64_t entries);
    bool draw_band(const FrameJob& job, Group& group, const Share& share, GroupPlanes& planes);
    bool draw_bands(const FrameJob& job, std::size_t number, Group& whole, const Share& share,
                    GroupPlanes& planes);
    static GroupPlanes new_planes(const FrameJob& job, const Group& group);
    void note_counts(GroupPlanes& planes) const;
    bool read_planes(const FrameJob& job, const Group& group, GroupPlanes& planes);
    Counts read_counts() const;
    void count(const FrameJob& job, const Group& group);
    bool is_shallow(const Group& group) const;
    bool fold_together(const FrameJob& job, const Group& group);
    bool fold_apart(const FrameJob& job, Group& group);
    int list_slabs(const FrameJob& job, const Group& group);
    void project(const FrameJob& job, const Group& group, int pass);
    void project_some(const FrameJob& job, const Group& group, const Splats& splats, int pass, GLuint every);
    void plan_pass(const Group& group, int pass);
    void scan(const CardBuffer& numbers, GLuint fixed_count, int of, int total, int slot);
    int sort(int in, int out, int of, GLuint first_key, GLuint last_key);
    int put_in_order(const Group& group);
    int list_entries(const Group& group, int order);
    void fold(const FrameJob& job, const Group& group, int by_tile);
    bool read(const CardBuffer& from, std::int64_t first_pixel, const Group& group, const FrameJob& job,
              Image& to);

    void mark(const char* pass);
    const GlProgram& program(const std::string& file, const std::string& defines);
    void dispatch(const GlProgram& program, std::int64_t groups);
    void indirect(const GlProgram& program, int slot);

    GlInfo info_;
    bool native_division_;
    int slabs_ = 0;
    std::int64_t room_ = 0, told_bytes_ = 0;
    GLenum free_memory_ = 0;  // what the driver is asked for it by; 0: it does not say
    Share share_;
    /// Of the last group for which the memory did not suffice at once, and how it was drawn.
    struct {
        std::int64_t splats = std::numeric_limits<std::int64_t>::max(), pixels = 0;
        std::size_t share = 0;
    } short_of_;
    bool lost_ = false;
    std::function<void(std::string& text)> edit_;
    std::int64_t most_bytes_ = 0;  // of a buffer
    double entries_each_ = 2.5;    // of a splat, in the last group
    std::uint64_t frames_ = 0;
    std::map<std::string, std::unique_ptr<GlProgram>> programs_;
    using Query = GlObject<&glGenQueries, &glDeleteQueries>;
    std::vector<std::pair<const char*, Query>> marks_;  // where passes begin; the last ends
    std::size_t marked_ = 0;
    std::map<std::uint64_t, KeptSet> sets_;  // by stamp
    CardBuffer look_uniforms_, look_map_, look_totals_;
    std::map<std::pair<std::uint64_t, const ShadedSplats*>, Kept> kept_;  // by stamp; without one, by place
    CardBuffer counts_, arguments_, begins_, entry_begins_, records_, tags_, rects_, sums_, digits_, ranges_,
        light_, through_, more_, layer_light_, ranks_, given_splats_, given_shapes_, layers_, nodes_,
        moments_, cosines_, staging_, sending_, child_radius_, child_fading_, child_steady_, child_total_;
    std::map<std::size_t, CardBuffer> children_;  // by layer, ScreenSplats
    std::byte* sent_ = nullptr;                   // where `sending_` is mapped
    std::array<CardBuffer, 4> keys_, values_;     // 0, 1: entries, and back and forth with 2, 3: records
    Buffer<ScreenSplat> given_;                   // that the processor has projected
    std::vector<float> shapes_;                   // twelve numbers a shape
};

/// One of its programs; defines with commas between them.
ProgramSource card_source(const std::string& file, const std::string& defines, bool native_division);

/// Whether the current context's card has the processor's bits: every operation that decides a pixel on 10^5
/// inputs, with the driver's own division and square root first, then two small scenes.
struct CardProbe {
    bool native_division = false;
    std::string fault;  // the first that differs; empty: none
    double seconds = 0.0;
};
CardProbe probe_card(const GlInfo& info);
/// The same, asked once: of this program's run, and of those that share `kept`, a folder that remembers what
/// was found of this card, driver and program; empty: none does. Throws NoContext where it cannot compute.
CardProbe known_probe(const GlInfo& info, const fs::path& kept);
/// The current context's card. Throws NoContext where the probe found a fault.
std::unique_ptr<Card> exact_card(const GlInfo& info, const CardProbe& probe);

/// A card that is asked for.
struct CardChoice {
    DeviceChoice device = DeviceChoice::automatic;
    fs::path kept = {};  // as known_probe() takes it
};

/// A card with a context of its own, on this machine and current on this thread, that draws exactly.
class OwnCard {
  public:
    /// `software`: also the processor's own OpenGL. Throws NoContext with the reason why there is none.
    OwnCard(const fs::path& kept, bool software);
    Card& card() { return *card_; }
    const GlInfo& info() const { return context_.info(); }
    const CardProbe& probe() const { return probe_; }

  private:
    OffscreenContext context_;
    CardProbe probe_;
    std::unique_ptr<Card> card_;
};

/// The card that the choice leads to; null: the processor draws, which the log's details say with the reason.
/// Of a driver that draws by the processor only where a card is asked for. Throws NoContext where that cannot
/// be had.
std::unique_ptr<OwnCard> open_card(const CardChoice& choice);

}  // namespace astrosplat
