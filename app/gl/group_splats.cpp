#include "gl/group_splats.h"

#include <algorithm>

#include "look/prepare.h"

namespace astrosplat {
namespace {

/// No splat of the set is larger, whatever its random numbers and alpha are.
float radius_bound(const SplatSet& set, const LookUniforms& u) {
    float radius = std::max(u.radius.smallest, u.radius.largest);
    if (u.radius.own)
        for (const float own : set.radius) radius = std::max(radius, own);
    return radius * std::max(1.0f, u.radius.horizontal_scale) * std::max(1.0f, u.radius.vertical_scale);
}

}  // namespace

RawSplats& RawSplatStore::of(const std::shared_ptr<const SplatSet>& set) {
    Entry& entry = entries_[set.get()];
    if (!entry.splats) entry.splats = std::make_unique<RawSplats>(set);
    entry.used = true;
    return *entry.splats;
}

void RawSplatStore::drop_unused() {
    for (auto entry = entries_.begin(); entry != entries_.end();) {
        const bool used = std::exchange(entry->second.used, false);
        entry = used ? std::next(entry) : entries_.erase(entry);
    }
}

bool GroupSplats::lay_out(const std::vector<const PreviewLayer*>& layers) {
    bool same = parts_.size() == layers.size();
    for (std::size_t l = 0; l < layers.size() && same; ++l)
        same = !layers[l]->layer.splats && parts_[l].set == layers[l]->set;
    if (same) return false;
    parts_.clear();
    parts_.resize(layers.size());
    std::int64_t first = 0;
    for (std::size_t l = 0; l < layers.size(); ++l) {
        if (!layers[l]->layer.splats) parts_[l].set = layers[l]->set;
        parts_[l].first = first;
        parts_[l].count = shown_count(*layers[l]);
        first += parts_[l].count;
    }
    buffers_.resize(first);
    order_valid_ = false;
    first_version_ = 0;
    return true;
}

void GroupSplats::upload(Part& part, const ShadedSplats& splats) {
    part.largest_radius = *std::max_element(splats.radius.begin(), splats.radius.end());
    buffers_.upload(splats, part.first);
}

bool GroupSplats::shade(Part& part, const PreviewLayer& layer, RawSplatStore& raw, LookPass& pass) {
    RawSplats& splats = raw.of(layer.set);
    Shading now = shading_of(layer);
    if (part.shading == now) return false;
    part.uniforms = prepare_look(*layer.set, layer.look, layer.inputs);
    part.shading = std::move(now);
    part.largest_radius = radius_bound(*layer.set, part.uniforms);
    splats.hold();
    pass.run(splats, {part.uniforms, layer.inputs.thickness_map}, buffers_, part.first);
    return true;
}

void GroupSplats::read_places() {
    places_ = std::make_shared<const Buffer<glm::vec4>>(buffers_.read_places());
    ++places_version_;
}

void GroupSplats::update(const std::vector<const PreviewLayer*>& layers, RawSplatStore& raw, LookPass& pass,
                         bool ordered) {
    bool changed = lay_out(layers);
    for (std::size_t l = 0; l < layers.size(); ++l) {
        if (parts_[l].count == 0) continue;
        if (layers[l]->layer.splats)
            upload(parts_[l], *layers[l]->layer.splats);
        else
            changed = shade(parts_[l], *layers[l], raw, pass) || changed;
    }
    if (changed) places_.reset();
    if (ordered && !places_) read_places();
}

bool GroupSplats::request_order(const std::vector<LayerProjection>& projections, double far_from,
                                OrderThread& thread, std::size_t slot) {
    View view;
    for (const LayerProjection& p : projections) {
        view.camera_from_layer.push_back(p.camera_from_layer);
        view.origin.push_back(p.origin_in_camera);
    }
    if (!projections.empty()) view.projection = projections[0].lens.projection;
    view.far_from = far_from;
    view.places_version = places_version_;
    if (view == requested_ && first_version_ != 0) return false;
    requested_ = view;
    requested_version_ = thread.next_version();
    if (first_version_ == 0) first_version_ = requested_version_;
    OrderJob job{places_, {}, {}, far_from, requested_version_};
    job.lens.projection = view.projection;
    for (std::size_t l = 0; l < parts_.size(); ++l)
        job.layers.push_back(
            {parts_[l].first, parts_[l].count, view.camera_from_layer[l], view.origin[l], parts_[l].set});
    thread.submit(slot, std::move(job));
    return true;
}

void GroupSplats::take_order(OrderThread& thread, std::size_t slot) {
    const std::optional<Order> order = thread.take(slot);
    if (!order || first_version_ == 0 || order->version < first_version_) return;
    buffers_.set_order(order->splats);
    ordered_count_ = static_cast<std::int64_t>(order->splats.size());
    far_count_ = order->far_count;
    order_version_ = order->version;
    order_valid_ = true;
}

}  // namespace astrosplat
