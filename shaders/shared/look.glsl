// The look of one splat: the seven steps of the design, value in, value out. look_splat is the whole; the functions
// before it are its steps, which the engine runs over blocks of splats, one step at a time, to the same bits. Needs
// maths.glsl, noise.glsl and look_uniforms.glsl.

// --- profiles over x ---

// Published fit of the nebula S106: three straight pieces, 0 from 1 on.
float look_s106(float x) {
    float y = x < 0.33f ? 1.0f - 1.515f * x : 0.9f - 1.212f * x;
    y = x < 0.66f ? y : 0.294f - 0.294f * x;
    return x < 1.0f ? y : 0.0f;
}

// Every shape but the curve; x >= 0. Never negative.
float look_formula(int shape, float rate, float x) {
    float y = 1.0f;
    float below = max(0.0f, 1.0f - x);
    if (shape == PROFILE_LINEAR) y = below;
    if (shape == PROFILE_QUADRATIC) y = below * below;
    if (shape == PROFILE_EXPONENTIAL) y = as_exp(-rate * x);
    if (shape == PROFILE_GAUSSIAN) y = as_exp(-rate * (x * x));
    if (shape == PROFILE_SMOOTH) y = x < 1.0f ? 1.0f - as_smooth(x) : 0.0f;
    if (shape == PROFILE_S106) y = look_s106(x);
    return y;
}

// Cubic Hermite piece from knot a to knot b, held between their values so that rounding cannot overshoot.
float look_curve_piece(vec4 a, vec4 b, float x) {
    float h = b.x - a.x;
    float t = h > 0.0f ? clamp(as_div(x - a.x, h), 0.0f, 1.0f) : 0.0f;
    float s = 1.0f - t;
    float y = a.y * (s * s * (1.0f + 2.0f * t)) + b.y * as_smooth(t);
    y = y + h * (s * t) * (a.z * s - b.z * t);
    return clamp(y, min(a.y, b.y), max(a.y, b.y));
}

float look_curve(LookCurve curve, float x) {
    vec4 a = curve.knots[0];
    vec4 b = curve.knots[0];
    for (int k = 0; k < LOOK_MAX_POINTS - 1; ++k) {
        bool reached = k + 1 < curve.count && x >= curve.knots[k].x;
        a = reached ? curve.knots[k] : a;
        b = reached ? curve.knots[k + 1] : b;
    }
    return look_curve_piece(a, b, x);
}

float look_profile(LookProfile profile, float x) {
    return profile.shape == PROFILE_CURVE ? look_curve(profile.curve, x) : look_formula(profile.shape, profile.rate, x);
}

// --- 1: thickness ---

// Texel coordinate along one side of the map for bilinear reading, clamped to the picture: floor is the first texel,
// the next one (at most size - 1) the second, the fraction its share. Rows count from the top: pass 1 - v.
float look_texel(float coordinate, int size) {
    float last = float(size - 1);
    float t = coordinate * float(size) - 0.5f;
    t = t > 0.0f ? t : 0.0f;
    return t < last ? t : last;
}

float look_bilinear(float c00, float c10, float c01, float c11, float tx, float ty) {
    return mix(mix(c00, c10, tx), mix(c01, c11, tx), ty);
}

// Weight of a stop before normalisation.
float look_weight(float r, float g, float b, vec3 color) {
    float dr = r - color.x;
    float dg = g - color.y;
    float db = b - color.z;
    float d = dr * dr + dg * dg + db * db + 1.0e-4f;
    return as_div(1.0f, d * d);
}

// Share of a quantity that noise value n leaves; it takes at most `amount` of it.
float look_bite(float amount, float n) { return 1.0f - amount * (0.5f + 0.5f * n); }

// x = distance / reach; a splat on the surface has 0 whatever the reach, one off a surface without reach is outside.
float look_x(float splat_distance, float reach) {
    float x = reach > 0.0f ? as_div(splat_distance, reach) : 2.0f;
    return splat_distance > 0.0f ? x : 0.0f;
}

// --- 2: density ---

bool look_keep(float x, float probability, uint seed, uint id_low, uint id_high) {
    return x <= 1.0f && as_uniform(as_hash(seed, id_low, id_high, PURPOSE_DENSITY)) < probability;
}

// Distance from the surface of a crop, below 0 inside; a, b and c are along the sides of its box.
float look_crop_distance(LookCrop crop, float px, float py, float pz) {
    float dx = px - crop.center.x;
    float dy = py - crop.center.y;
    float dz = pz - crop.center.z;
    float a = abs(dx * crop.x.x + dy * crop.x.y + dz * crop.x.z) - crop.half_x;
    float b = abs(dx * crop.y.x + dy * crop.y.y + dz * crop.y.z) - crop.half_y;
    float c = abs(dx * crop.z.x + dy * crop.z.y + dz * crop.z.z) - crop.half_z;
    float oa = max(a, 0.0f);
    float ob = max(b, 0.0f);
    float oc = max(c, 0.0f);
    return sqrt(oa * oa + ob * ob + oc * oc) + min(max(a, max(b, c)), 0.0f) - crop.radius;
}

// How far within a surface at distance d a splat is: 1 inside of a band of width `soft`, 0 outside of it. With a band
// of no width the surface itself is inside.
float look_inside(float d, float soft) {
    float hard = d <= 0.0f ? 1.0f : 0.0f;
    return as_smooth(soft > 0.0f ? clamp(0.5f - as_div(d, soft), 0.0f, 1.0f) : hard);
}

// Share of a splat's alpha that a crop leaves there.
float look_crop(LookCrop crop, float px, float py, float pz) {
    float inside = look_inside(look_crop_distance(crop, px, py, pz), crop.soft);
    return crop.outside != 0 ? 1.0f - inside : inside;
}

// A splat as an outline's view has it: right and up as its points are, and what they are multiplied by there to be
// scene units; 0 behind the eye.
vec3 look_outline_place(LookOutline outline, float px, float py, float pz) {
    float dx = px - outline.eye.x;
    float dy = py - outline.eye.y;
    float dz = pz - outline.eye.z;
    float right = dx * outline.right.x + dy * outline.right.y + dz * outline.right.z;
    float up = dx * outline.up.x + dy * outline.up.y + dz * outline.up.z;
    float depth = dx * outline.forward.x + dy * outline.forward.y + dz * outline.forward.z;
    bool seen = outline.parallel != 0 || depth > 0.0f;
    float scale = outline.parallel != 0 ? 1.0f : (seen ? depth : 1.0f);
    return vec3(as_div(right, scale), as_div(up, scale), seen ? scale : 0.0f);
}

// Whether a place lies so far from all of an outline that nothing of its band reaches it.
bool look_beyond_outline(LookOutline outline, float x, float y, float scale) {
    float off = max(max(outline.bounds.x - x, x - outline.bounds.z), max(outline.bounds.y - y, y - outline.bounds.w));
    return !((off - outline.half_width) * scale <= 0.5f * outline.soft) || !(scale > 0.0f);
}

// Square of the distance from an edge.
float look_edge_distance2(LookEdge edge, float x, float y) {
    float px = x - edge.x;
    float py = y - edge.y;
    float t = clamp((px * edge.dx + py * edge.dy) * edge.per_length2, 0.0f, 1.0f);
    float ox = px - t * edge.dx;
    float oy = py - t * edge.dy;
    return ox * ox + oy * oy;
}

// 1 where a ray to the right crosses an edge.
int look_edge_crossed(LookEdge edge, float x, float y) {
    bool spans = (edge.y > y) != (edge.end_y > y);
    return spans && x - edge.x < (y - edge.y) * edge.slope ? 1 : 0;
}

// As look_inside: from the least squared distance of its edges, how often they are crossed, and the scale of
// look_outline_place().
float look_inside_outline(LookOutline outline, float distance2, int crossed, float scale, bool beyond) {
    float off = sqrt(distance2);
    float d = outline.half_width > 0.0f ? off - outline.half_width : ((crossed & 1) != 0 ? -off : off);
    return beyond ? 0.0f : look_inside(d * scale, outline.soft);
}

// --- 4: horizontal alpha ---

// Factor of the colour: 1 / alpha where the step applies and there is an alpha to divide by.
float look_unpremultiply(float alpha, LookAlpha step) {
    return alpha < step.threshold && alpha > 0.0f ? as_div(1.0f, alpha) : 1.0f;
}

float look_gain(float alpha, LookAlpha step) { return clamp(alpha * step.gain, 0.0f, 1.0f); }

float look_horizontal(float alpha, LookAlpha step) {
    return look_gain(alpha < step.threshold ? as_pow(alpha, step.power) : alpha, step);
}

// --- 5: vertical alpha ---

// -ln(1 - min(a, 0.998)), accurate for small a as well: log(u) (1 - u exactly known) scaled by m / (1 - u) (Kahan).
float look_depth(float alpha) {
    float m = min(alpha, 0.998f);
    float u = 1.0f - m;
    float lost = 1.0f - u;
    return lost > 0.0f ? -as_log(u) * as_div(m, lost) : m;
}

// Factor of the radius by the alpha of step 4.
float look_horizontal_radius(float alpha, LookRadius step) {
    return 1.0f + (step.horizontal_scale - 1.0f) * (1.0f - alpha);
}

// The mean of a column of splats whose alpha would be f alone; 0 where nothing can be matched.
float look_column(int match, float column, float reach, float horizontal_radius) {
    float area = match == MATCH_PLANES ? 1.0f : horizontal_radius * horizontal_radius;
    return column * reach * area;
}

// Alpha after matching: the column of all such splats, seen along the normal, shows `alpha`.
float look_matched(int match, float alpha, float f, float column) {
    float a = match >= MATCH_TRANSMITTANCE ? look_depth(alpha) : alpha;
    float y = column > 0.0f ? min(1.0f, as_div(a * f, column)) : 0.0f;
    return match == MATCH_NONE ? alpha * f : y;
}

// --- 6: radius ---

float look_uniform_radius(LookRadius step, uint seed, uint id_low, uint id_high) {
    return step.smallest +
           (step.largest - step.smallest) * as_uniform(as_hash(seed, id_low, id_high, PURPOSE_RADIUS));
}

float look_vertical_radius(float x, LookRadius step) { return 1.0f + (step.vertical_scale - 1.0f) * x; }

// --- 7: variation and grade ---

float look_vary(float amount, float n) { return max(0.0f, 1.0f + amount * n); }

float look_levels(float c, LookGrade step) {
    return max(0.0f, as_div(c - step.black, max(1.0f - step.black, 1.0e-6f)));
}

float look_luminance(float r, float g, float b) { return 0.2126f * r + 0.7152f * g + 0.0722f * b; }

float look_finish(float c, float luminance, LookGrade step) {
    return as_pow(max(0.0f, c * step.saturation + luminance * (1.0f - step.saturation)), step.inverse_gamma);
}

// Whether look_finish changes anything.
bool look_finishes(LookGrade step) { return step.saturation != 1.0f || step.inverse_gamma != 1.0f; }

// look_depth by its series where it is small: shader compilers may cancel 1 - (1 - m), which costs its last digits.
float look_small_depth(float alpha) {
    float series = alpha * (1.0f + alpha * (0.5f + alpha * (0.33333333f + alpha * 0.25f)));
    return alpha < 0.03f ? series : look_depth(alpha);
}

// One channel of splats whose column is to show light `alpha` c when screened: 1 - e^(-depth c') = alpha c.
float look_screened(float alpha, float c) {
    float depth = look_small_depth(alpha);
    return depth > 0.0f ? as_div(look_small_depth(alpha * c), depth) : c;
}

// --- the whole ---

struct LookInput {
    vec3 position;
    vec3 color;
    float alpha;
    float from_surface;  // scene units, >= 0
    float radius;        // used where own_radius is 1
    vec3 map_value;      // used where there are several stops
    uint id_low;
    uint id_high;
    float outlined;  // share of alpha that outlines leave; 1 without them
};

struct LookOutput {
    bool keep;
    float probability;  // of being kept
    vec3 position;
    vec3 color;
    float alpha;
    float radius;
};

float look_noise(LookNoise noise, vec3 p) {
    return as_fbm(p.x, p.y, p.z, noise.frequency, noise.octaves, noise.lacunarity, noise.gain, noise.scale,
                  noise.seed);
}

// The point's projection onto the plane through the origin across the axis.
vec3 look_across(vec3 p, vec3 axis) { return p - axis * dot(p, axis); }

LookOutput look_splat(LookUniforms u, LookInput s) {
    float n[LOOK_MAX_NOISES];
    float scale = 0.0f;
    float density = 0.0f;
    float column = 0.0f;
    float weight_sum = 0.0f;
    float weight[LOOK_MAX_STOPS];
    float reach = 1.0f;
    float culled = 1.0f;
    float along = 0.0f;
    float alpha_factor = 1.0f;
    float color_factor = 1.0f;
    for (int j = 0; j < LOOK_MAX_NOISES; ++j) {
        if (j < u.noise_count) {
            n[j] = look_noise(u.noises[j], s.position);
            if (u.noises[j].silhouette != 0.0f) {
                float across = look_noise(u.noises[j], look_across(s.position, u.axis));
                reach = reach * look_bite(u.noises[j].silhouette, across);
            }
            culled = culled * look_bite(u.noises[j].cull, n[j]);
            along = along + u.noises[j].jitter * n[j];
            alpha_factor = alpha_factor * look_vary(u.noises[j].alpha, n[j]);
            color_factor = color_factor * look_vary(u.noises[j].brightness, n[j]);
        }
    }

    for (int k = 0; k < LOOK_MAX_STOPS; ++k) {
        if (k < u.stop_count) {
            weight[k] = look_weight(s.map_value.x, s.map_value.y, s.map_value.z, u.stops[k].color);
            weight_sum = weight_sum + weight[k];
        }
    }
    for (int k = 0; k < LOOK_MAX_STOPS; ++k) {
        if (k < u.stop_count) {
            weight[k] = u.stop_count > 1 ? as_div(weight[k], weight_sum) : 1.0f;
            scale = scale + weight[k] * u.stops[k].scale;
            column = column + weight[k] * u.stops[k].column;
        }
    }
    reach = u.reach * scale * reach;
    float x = look_x(s.from_surface, reach);
    float cropped = s.outlined;
    for (int j = 0; j < LOOK_MAX_CROPS; ++j) {
        if (j < u.crop_count) cropped = cropped * look_crop(u.crops[j], s.position.x, s.position.y, s.position.z);
    }
    for (int k = 0; k < LOOK_MAX_STOPS; ++k) {
        if (k < u.stop_count) density = density + weight[k] * look_profile(u.stops[k].pdf, x);
    }

    LookOutput result;
    float probability = u.density * density * culled;
    result.keep = look_keep(x, probability, u.seed, s.id_low, s.id_high) && cropped > 0.0f;
    result.probability = x <= 1.0f ? clamp(probability, 0.0f, 1.0f) : 0.0f;
    result.position = s.position + u.axis * along;

    float undo = u.alpha.unpremultiply != 0 ? look_unpremultiply(s.alpha, u.alpha) : 1.0f;
    float alpha = look_horizontal(s.alpha, u.alpha);
    float radius_factor = look_horizontal_radius(alpha, u.radius);
    float vertical_x = u.vertical_reach > 0.0f ? as_div(s.from_surface, u.vertical_reach) : x;
    float f = look_profile(u.vertical, vertical_x);
    float mean = look_column(u.match, column, reach, radius_factor);
    bool absorbs = u.absorbs != 0 && s.color.x < 0.0f;
    result.alpha = absorbs ? s.alpha : clamp(look_matched(u.match, alpha, f, mean) * alpha_factor, 0.0f, 1.0f);
    result.alpha = result.alpha * cropped;

    float radius = look_uniform_radius(u.radius, u.seed, s.id_low, s.id_high);
    radius = u.radius.own != 0 ? s.radius : radius;
    result.radius = radius * radius_factor * look_vertical_radius(x, u.radius);

    float r = look_levels(s.color.x * undo * color_factor, u.grade) * u.grade.tint.x;
    float g = look_levels(s.color.y * undo * color_factor, u.grade) * u.grade.tint.y;
    float b = look_levels(s.color.z * undo * color_factor, u.grade) * u.grade.tint.z;
    float luminance = look_luminance(r, g, b);
    result.color = vec3(absorbs ? s.color.x : look_finish(r, luminance, u.grade),
                        absorbs ? s.color.y : look_finish(g, luminance, u.grade),
                        absorbs ? s.color.z : look_finish(b, luminance, u.grade));
    if (u.match == MATCH_SCREEN && !absorbs)
        result.color = vec3(look_screened(alpha, result.color.x), look_screened(alpha, result.color.y),
                            look_screened(alpha, result.color.z));
    return result;
}
