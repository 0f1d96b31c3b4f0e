#include "bodies/gaussian_sum.h"

#include <numeric>

#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "image/channels.h"

namespace astrosplat {

AlongEllipses along(const Ellipses& e, double x, double y) {
    const double c = real::cos(e.angle), s = real::sin(e.angle);
    return {(x - e.x) * c + (y - e.y) * s, -(x - e.x) * s + (y - e.y) * c};
}

std::vector<double> geometric(double from, double to, int count) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i)
        values.push_back(from * real::exp(real::log(to / from) * i / (count - 1.0)));
    return values;
}

GaussianBasis basis_of(const Ellipses& e, const Image& light, const std::vector<double>& sigmas) {
    GaussianBasis basis{2 * int(sigmas.size()) + 1, {}};
    basis.values.resize(light.pixels.size() * std::size_t(basis.count));
    const double c = real::cos(e.angle), s = real::sin(e.angle);
    for_each_pixel(light, [&](std::int64_t x, std::int64_t y) {
        float* out = basis.values.data() + (y * light.width + x) * basis.count;
        const double dx = double(x) - e.x, dy = double(y) - e.y;
        const double u = dx * c + dy * s, v = -dx * s + dy * c;
        for (const double q : {e.disk, e.spheroid}) {
            const double r2 = u * u + v * v / (q * q);
            for (const double sigma : sigmas) *out++ = shared::as_exp(float(-0.5 * r2 / (sigma * sigma)));
        }
        *out = 1.0f;
    });
    return basis;
}

namespace {

// Normal equations of a square matrix in rows, of which the upper half counts.
struct Equations {
    std::vector<double> matrix, right;
    explicit Equations(std::size_t n) : matrix(n * n, 0.0), right(n, 0.0) {}
};

// Pixels that are added in one pass over the matrix, each after the one before.
struct PixelGroup {
    static constexpr std::size_t size = 4;
    std::vector<double> values;  // of each pixel, side by side
    std::array<double, size> weight{}, light{};
    explicit PixelGroup(std::size_t n) : values(size * n) {}
};

void add_pixels(const PixelGroup& g, Equations& e) {
    const std::size_t n = e.right.size();
    const double *const v0 = g.values.data(), *const v1 = v0 + n, *const v2 = v1 + n, *const v3 = v2 + n;
    for (std::size_t i = 0; i < n; ++i) {
        const double a0 = g.weight[0] * v0[i], a1 = g.weight[1] * v1[i], a2 = g.weight[2] * v2[i],
                     a3 = g.weight[3] * v3[i];
        double* const row = e.matrix.data() + i * n;
        for (std::size_t j = i; j < n; ++j)
            row[j] = row[j] + a0 * v0[j] + a1 * v1[j] + a2 * v2[j] + a3 * v3[j];
        e.right[i] = e.right[i] + a0 * g.light[0] + a1 * g.light[1] + a2 * g.light[2] + a3 * g.light[3];
    }
}

Equations equations_of(const GaussianBasis& basis, const Image& light, const std::vector<double>& weights) {
    constexpr std::int64_t chunk = 2048;  // px
    const auto n = std::size_t(basis.count);
    const auto pixels = std::int64_t(light.pixels.size());
    std::vector<Equations> parts(std::size_t((pixels + chunk - 1) / chunk), Equations(n));
    parallel_chunks(pixels, chunk, [&](std::int64_t begin, std::int64_t end, int) {
        PixelGroup group(n);
        for (std::int64_t first = begin; first < end; first += PixelGroup::size) {
            for (std::size_t k = 0; k < PixelGroup::size; ++k) {
                const std::int64_t p = std::min(first + std::int64_t(k), end - 1);
                const bool there = first + std::int64_t(k) < end;
                std::ranges::copy(basis.of(std::size_t(p)), group.values.begin() + std::ptrdiff_t(k * n));
                group.weight[k] = there ? weights[p] : 0.0;
                group.light[k] = double(light.pixels[p]);
            }
            add_pixels(group, parts[begin / chunk]);
        }
    });
    Equations sum(n);
    for (const Equations& part : parts) {
        std::ranges::transform(part.matrix, sum.matrix, sum.matrix.begin(), std::plus());
        std::ranges::transform(part.right, sum.right, sum.right.begin(), std::plus());
    }
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < i; ++j) sum.matrix[i * n + j] = sum.matrix[j * n + i];
    return sum;
}

// The solution of some of the equations, the others' unknowns 0: Cholesky. The matrix is positive definite.
std::vector<double> solved(const Equations& e, const std::vector<std::size_t>& some) {
    const std::size_t n = e.right.size(), m = some.size();
    std::vector<double> lower(m * m), x(m);
    const auto product = [&](std::size_t i, std::size_t j) {  // of what is known of two rows
        const double* const a = lower.data() + i * m;
        return std::inner_product(a, a + j, lower.data() + j * m, 0.0);
    };
    for (std::size_t i = 0; i < m; ++i) {
        for (std::size_t j = 0; j < i; ++j)
            lower[i * m + j] = (e.matrix[some[i] * n + some[j]] - product(i, j)) / lower[j * m + j];
        const double square = e.matrix[some[i] * n + some[i]] - product(i, i);
        lower[i * m + i] = std::sqrt(std::max(square, 1e-300));
        const double known = std::inner_product(x.begin(), x.begin() + std::ptrdiff_t(i), &lower[i * m], 0.0);
        x[i] = (e.right[some[i]] - known) / lower[i * m + i];
    }
    for (std::size_t i = m; i-- > 0;) {
        for (std::size_t k = i + 1; k < m; ++k) x[i] -= lower[k * m + i] * x[k];
        x[i] /= lower[i * m + i];
    }
    return x;
}

// Goes from x towards the solution for some of the unknowns as far as none is below 0, and leaves out those
// that are 0 then. Whether it arrived.
bool go_towards(const std::vector<double>& solution, std::vector<std::size_t>& some, std::vector<double>& x) {
    double step = 1.0;
    for (std::size_t k = 0; k < some.size(); ++k)
        if (solution[k] <= 0.0)
            step = std::min(step, x[some[k]] / std::max(x[some[k]] - solution[k], 1e-300));
    std::vector<std::size_t> kept;
    for (std::size_t k = 0; k < some.size(); ++k) {
        double& value = x[some[k]];
        value += step * (solution[k] - value);
        if (solution[k] > 0.0 || value > 1e-12)
            kept.push_back(some[k]);
        else
            value = 0.0;
    }
    some = std::move(kept);
    return step >= 1.0;
}

// The unknown that is not among `some`, by which the squares fall the most; empty where none would.
std::optional<std::size_t> steepest(const Equations& e, const std::vector<double>& x,
                                    const std::vector<std::size_t>& some, const std::vector<bool>& allowed) {
    const std::size_t n = x.size();
    double most = 1e-10 * std::ranges::max(e.right);
    std::optional<std::size_t> next;
    for (std::size_t i = 0; i < n; ++i) {
        if (!allowed[i] || std::ranges::count(some, i) > 0) continue;
        const double fall = e.right[i] - std::inner_product(x.begin(), x.end(), &e.matrix[i * n], 0.0);
        if (fall > most) most = fall, next = i;
    }
    return next;
}

}  // namespace

// Lawson and Hanson 1974, algorithm NNLS, on normal equations.
std::vector<double> nonnegative_amplitudes(const GaussianBasis& basis, const Image& light,
                                           const std::vector<double>& weights,
                                           const std::vector<bool>& allowed) {
    Equations e = equations_of(basis, light, weights);
    const std::size_t n = e.right.size();
    double trace = 0.0;
    for (std::size_t i = 0; i < n; ++i) trace += e.matrix[i * n + i];
    for (std::size_t i = 0; i < n; ++i) e.matrix[i * n + i] += 1e-7 * trace / double(n);
    std::vector<double> x(n, 0.0);
    std::vector<std::size_t> some;
    for (std::size_t turn = 0; turn < 3 * n; ++turn) {
        const std::optional<std::size_t> next = steepest(e, x, some, allowed);
        if (!next) break;
        some.push_back(*next);
        while (!some.empty() && !go_towards(solved(e, some), some, x)) {
        }
    }
    return x;
}

std::vector<double> sum_of(const GaussianBasis& basis, const std::vector<double>& amplitudes) {
    std::vector<double> sum(basis.values.size() / std::size_t(basis.count));
    parallel_each(sum.size(), 2048, [&](std::size_t p) {
        const std::span<const float> values = basis.of(p);
        for (std::size_t i = 0; i < values.size(); ++i) sum[p] += double(values[i]) * amplitudes[i];
    });
    return sum;
}

}  // namespace astrosplat
