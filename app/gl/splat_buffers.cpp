#include "gl/splat_buffers.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <numeric>

#include "camera/projection.h"
#include "core/sorting.h"

namespace astrosplat {
namespace {

/// A float array as a vertex attribute; an array the set does not have reads as zeros.
template <class T>
void upload(GLuint location, GlBuffer& buffer, const Buffer<T>& values, std::int64_t count) {
    if (values.empty()) {
        glDisableVertexAttribArray(location);
        glVertexAttrib4f(location, 0.0f, 0.0f, 0.0f, 0.0f);
        return;
    }
    glBindBuffer(GL_ARRAY_BUFFER, buffer.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(sizeof(T)) * count, values.data(), GL_STATIC_DRAW);
    glEnableVertexAttribArray(location);
    if constexpr (std::is_same_v<T, std::uint64_t>)  // low word first, as this machine stores it
        glVertexAttribIPointer(location, 2, GL_UNSIGNED_INT, 0, nullptr);
    else
        glVertexAttribPointer(location, static_cast<GLint>(sizeof(T) / sizeof(float)), GL_FLOAT, GL_FALSE, 0,
                              nullptr);
}

void set_float4(GLuint location, GLuint buffer) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void allocate(GLuint buffer, std::int64_t count) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(sizeof(glm::vec4)) * count, nullptr,
                 GL_DYNAMIC_COPY);
}

void attach(GLuint texture, GLuint buffer) {
    glBindTexture(GL_TEXTURE_BUFFER, texture);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, buffer);
}

Buffer<glm::vec4> read_float4(GLuint buffer, std::int64_t count) {
    Buffer<glm::vec4> values(static_cast<std::size_t>(count));
    if (count == 0) return values;
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glGetBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(sizeof(glm::vec4)) * count, values.data());
    return values;
}

void write_float4(GLuint buffer, std::int64_t first, const Buffer<glm::vec4>& values) {
    constexpr auto stride = static_cast<GLintptr>(sizeof(glm::vec4));
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferSubData(GL_ARRAY_BUFFER, first * stride, static_cast<GLsizeiptr>(values.size()) * stride,
                    values.data());
}

/// ~depth in the upper half, so that ascending is far to near; the splat's index below.
using Code = std::uint64_t;

std::uint32_t depth_bits(const OrderLayer& layer, const glm::vec4& place, const Lens& lens) {
    const glm::vec3 p(layer.camera_from_layer * glm::dvec3(place) + layer.origin_in_camera);
    const float code = shared::sort_depth(lens, p);
    return code > 0.0f ? std::bit_cast<std::uint32_t>(code) : 0u;
}

void make_codes(const OrderJob& job, Buffer<Code>& codes) {
    codes.clear();
    codes.reserve(job.places->size());
    for (const OrderLayer& layer : job.layers) {
        for (std::int64_t i = layer.first; i < layer.first + layer.count; ++i) {
            const glm::vec4& place = (*job.places)[static_cast<std::size_t>(i)];
            if (place.w < 0.0f) continue;
            codes.push_back(Code{~depth_bits(layer, place, job.lens)} << 32 | Code(i));
        }
    }
}

/// Layer and id of a splat: larger is farther at equal depth.
struct TieBreak {
    const OrderJob& job;
    std::pair<std::size_t, std::uint64_t> of(Code code) const {
        const auto i = static_cast<std::int64_t>(code & 0xffffffffu);
        std::size_t l = job.layers.size() - 1;
        while (l > 0 && i < job.layers[l].first) --l;
        const auto row = static_cast<std::size_t>(i - job.layers[l].first);
        return {l, job.layers[l].set ? job.layers[l].set->id[row] : row};
    }
    bool operator()(Code a, Code b) const { return of(a) > of(b); }
};

void break_ties(const OrderJob& job, Buffer<Code>& codes) {
    for (std::size_t i = 0; i < codes.size();) {
        std::size_t end = i + 1;
        while (end < codes.size() && codes[end] >> 32 == codes[i] >> 32) ++end;
        if (end - i > 1)
            std::sort(codes.begin() + std::ptrdiff_t(i), codes.begin() + std::ptrdiff_t(end), TieBreak{job});
        i = end;
    }
}

}  // namespace

void RawSplats::hold() {
    if (vertices_.name() != 0) return;
    glBindVertexArray(vertices_.get());
    const std::int64_t count = set_->size();
    upload(0, buffers_[0], set_->position, count);
    upload(1, buffers_[1], set_->color, count);
    upload(2, buffers_[2], set_->alpha, count);
    upload(3, buffers_[3], set_->distance, count);
    upload(4, buffers_[4], set_->id, count);
    upload(5, buffers_[5], set_->uv, count);
    upload(6, buffers_[6], set_->radius, count);
    glBindVertexArray(0);
}

void ShadedBuffers::resize(std::int64_t count) {
    if (count == size_ && places_.name() != 0) return;
    size_ = count;
    allocate(places_.get(), std::max<std::int64_t>(count, 1));
    allocate(colors_.get(), std::max<std::int64_t>(count, 1));
    glBindVertexArray(points_.get());
    set_float4(0, places_.name());
    set_float4(1, colors_.name());
    glBindVertexArray(0);
    attach(place_texture_.get(), places_.name());
    attach(color_texture_.get(), colors_.name());
}

void ShadedBuffers::upload(const ShadedSplats& splats, std::int64_t first) {
    const auto count = splats.position.size();
    Buffer<glm::vec4> places(count), colors(count);
    for (std::size_t i = 0; i < count; ++i) {
        places[i] = glm::vec4(splats.position[i], splats.radius[i]);
        colors[i] = glm::vec4(splats.color[i], splats.alpha[i]);
    }
    write_float4(places_.name(), first, places);
    write_float4(colors_.name(), first, colors);
}

Buffer<glm::vec4> ShadedBuffers::read_places() const { return read_float4(places_.name(), size_); }
Buffer<glm::vec4> ShadedBuffers::read_colors() const { return read_float4(colors_.name(), size_); }

void ShadedBuffers::set_order(const Buffer<std::uint32_t>& order) {
    glBindBuffer(GL_ARRAY_BUFFER, order_.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(order.size() * sizeof(std::uint32_t)), order.data(),
                 GL_STREAM_DRAW);
}

void ShadedBuffers::draw_points(bool ordered, std::int64_t first, std::int64_t count) {
    if (count <= 0) return;
    glBindVertexArray(points_.get());
    if (ordered) {
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, order_.get());
        const auto offset = static_cast<std::uintptr_t>(first) * sizeof(std::uint32_t);
        glDrawElements(GL_POINTS, static_cast<GLsizei>(count), GL_UNSIGNED_INT,
                       reinterpret_cast<const void*>(offset));
    } else {
        glDrawArrays(GL_POINTS, static_cast<GLint>(first), static_cast<GLsizei>(count));
    }
    glBindVertexArray(0);
}

void ShadedBuffers::draw_quads(bool ordered, std::int64_t first, std::int64_t count, int unit) {
    if (count <= 0) return;
    if (!ordered && counted_ < size_) {
        Buffer<std::uint32_t> numbers(static_cast<std::size_t>(size_));
        std::iota(numbers.begin(), numbers.end(), 0u);
        glBindBuffer(GL_ARRAY_BUFFER, counting_.get());
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(numbers.size() * sizeof(std::uint32_t)),
                     numbers.data(), GL_STATIC_DRAW);
        counted_ = size_;
    }
    bind_texture(unit, GL_TEXTURE_BUFFER, place_texture_.name());
    bind_texture(unit + 1, GL_TEXTURE_BUFFER, color_texture_.name());
    glBindVertexArray(quads_.get());
    glBindBuffer(GL_ARRAY_BUFFER, ordered ? order_.get() : counting_.get());
    glEnableVertexAttribArray(2);
    const auto offset = static_cast<std::uintptr_t>(first) * sizeof(std::uint32_t);
    glVertexAttribIPointer(2, 1, GL_UNSIGNED_INT, 0, reinterpret_cast<const void*>(offset));
    glVertexAttribDivisor(2, 1);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(count));
    glBindVertexArray(0);
}

/// Radix sort of (inverted depth bits, index), as SplatSorter in the engine; equal depths by layer and id.
Order sort_far_to_near(const OrderJob& job, OrderScratch& scratch) {
    Buffer<Code>& codes = scratch.codes;
    make_codes(job, codes);
    scratch.other.resize(codes.size());
    const Code* const sorted = radix_sort<11>(
        codes.data(), scratch.other.data(), codes.size(), 32, 64, [](Code code) { return code; }, [] {});
    if (sorted != codes.data()) codes.swap(scratch.other);
    break_ties(job, codes);
    Order order;
    order.version = job.version;
    order.splats.resize(codes.size());
    for (std::size_t i = 0; i < codes.size(); ++i) order.splats[i] = static_cast<std::uint32_t>(codes[i]);
    const float limit = shared::sort_depth_of(job.lens, static_cast<float>(job.far_from));
    const Code nearest_far = Code{~std::bit_cast<std::uint32_t>(std::max(limit, 0.0f))} << 32;
    order.far_count = std::lower_bound(codes.begin(), codes.end(), nearest_far) - codes.begin();
    return order;
}

void OrderThread::submit(std::size_t slot, OrderJob job) {
    {
        const auto held = worker_.lock();
        jobs_[slot] = std::move(job);
    }
    worker_.wake();
}

std::optional<Order> OrderThread::take(std::size_t slot) {
    const auto held = worker_.lock();
    const auto found = orders_.find(slot);
    if (found == orders_.end()) return std::nullopt;
    std::optional<Order> order(std::move(found->second));
    orders_.erase(found);
    return order;
}

bool OrderThread::busy() const {
    const auto held = worker_.lock();
    return worker_.working() || !jobs_.empty();
}

bool OrderThread::wait(std::chrono::microseconds at_most) {
    return worker_.wait_for(at_most, [this] { return !worker_.working() && jobs_.empty(); });
}

Worker::Task OrderThread::next_job() {
    if (jobs_.empty()) return {};
    const std::size_t slot = jobs_.begin()->first;
    return [this, slot, job = std::move(jobs_.extract(slot).mapped())] {
        Order order = sort_far_to_near(job, scratch_);
        const auto held = worker_.lock();
        orders_[slot] = std::move(order);
    };
}

}  // namespace astrosplat
