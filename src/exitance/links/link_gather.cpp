#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>

#include "exitance/base/parallel.hpp"
#include "exitance/base/processor.hpp"
#include "exitance/base/trace.hpp"
#include "exitance/links/link_layout.hpp"
#include "exitance/links/links.hpp"

// Gathering of light over links. Cost per link matters most: there are many.
namespace exitance {
namespace {

constexpr std::size_t grain = 16;

template <std::size_t lanes>
struct LanesOf {
    typedef float Floats __attribute__((vector_size(4 * lanes)));
    typedef double Doubles __attribute__((vector_size(8 * lanes)));
};
template <std::size_t lanes>
using Floats = typename LanesOf<lanes>::Floats;
template <std::size_t lanes>
using Doubles = typename LanesOf<lanes>::Doubles;

template <std::size_t lanes>
EXITANCE_INLINE Floats<lanes> load(const float* p) {
    Floats<lanes> out;
    __builtin_memcpy(&out, p, sizeof out);
    return out;
}

template <class Lanes>
EXITANCE_INLINE Lanes positive(const Lanes& v) {
    return v > 0 ? v : Lanes{};
}

/// Forces an array into memory: broadcasting one value to all lanes from there is a single load, from registers two
/// shuffles.
template <class Array>
EXITANCE_INLINE void keep_in_memory(Array& array) {
    asm volatile("" : "+m"(array));
}

/// Per bit mask: 1 in the lanes whose bits are set, 0 in the others.
struct LaneMasks {
    alignas(32) float of[256][8];
    LaneMasks() {
        for (int bits = 0; bits < 256; ++bits)
            for (int lane = 0; lane < 8; ++lane) of[bits][lane] = static_cast<float>(bits >> lane & 1);
    }
};
const LaneMasks lane_masks;

/// The data of a source that links need, contiguous in memory. Its centre is in metres. The rest is in single
/// precision, in units of the scene's size: its nodes, relative to the centre, and the light that they emit.
template <std::size_t n>
struct alignas(64) SourceRecord {
    double centre[3];
    float normal[3];
    float node[3][n];
    float light[bands][n];  ///< w_l A b_l / pi
};

/// Prefetches a record while others are processed.
template <std::size_t n>
void prefetch(const SourceRecord<n>& record) {
    for (std::size_t byte = 0; byte < sizeof record; byte += 64)
        __builtin_prefetch(reinterpret_cast<const char*>(&record) + byte);
}

template <std::size_t n>
void fill(SourceRecord<n>& out, const LinkSites& sites, const NodalField& b, ElementId e, double scale) {
    const Patch frame = sites.frame(e);
    const Point centre = frame.centre();
    const double area = sites.tree().area(e) * scale * scale / pi;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.centre[axis] = centre[axis];
        out.normal[axis] = static_cast<float>(sites.normal(e)[axis]);
    }
    for (std::size_t l = 0; l < n; ++l) {
        const Vec3 at = scale * (sites.node(frame, l) - centre);
        for (std::size_t axis = 0; axis < 3; ++axis) out.node[axis][l] = static_cast<float>(at[axis]);
    }
    for (std::size_t l = 0; l < n; ++l) {
        const double share = area * sites.weight(e, l);
        for (std::size_t band = 0; band < bands; ++band)
            out.light[band][l] = static_cast<float>(share) * b.at(e, band)[l];
    }
}

/// One receiver and the light received so far. Its nodes 0 to lanes - 1 are lanes. For a remaining last node, the lanes
/// are the nodes of the source, and are summed at the end.
///
/// All nodes of an element are in one plane. Therefore n . d depends only on the source's node and m . d only on the
/// receiver's; per pair of nodes only the distance remains to be computed:
///
///     E_k = max(0, m . (x_k - y)) sum_l  V_kl / |y_l - x_k|^4  max(0, n . (y_l - x)) w_l A b_l / pi
template <class Layout>
class ReceivedLight {
    static constexpr std::size_t lanes = Layout::lanes, n = Layout::n;
    using Lanes = Floats<lanes>;

  public:
    ReceivedLight(const LinkSites& sites, ElementId p, double scale) : centre_(sites.centre(p)), scale_(scale) {
        for (std::size_t axis = 0; axis < 3; ++axis) normal_[axis] = static_cast<float>(sites.normal(p)[axis]);
        for (std::size_t k = 0; k < n; ++k) {
            const Vec3 at = scale * (sites.receiving_node(p, k) - centre_);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto x = static_cast<float>(at[axis]);
                if (k < lanes)
                    x_[axis][k] = x;
                else
                    rest_[axis] = x;
            }
        }
    }

    /// Adds a link with a recomputed, scaled kernel; `visible` as in Links.
    EXITANCE_INLINE void add(const SourceRecord<n>& q, float scale, const std::uint32_t* visible) {
        float D[3];
        for (std::size_t axis = 0; axis < 3; ++axis)
            D[axis] = static_cast<float>(scale_ * (q.centre[axis] - centre_[axis]));
        float y[3][n], light[bands][n];
        send(q, D, y, light);
        keep_in_memory(y), keep_in_memory(light);

        const Lanes there = scale * positive(q.normal[0] * (x_[0] - D[0]) + q.normal[1] * (x_[1] - D[1]) +
                                             q.normal[2] * (x_[2] - D[2]));
        Lanes arrived[bands]{};
        for (std::size_t l = 0; l < n; ++l) {
            const Lanes dx = y[0][l] - x_[0], dy = y[1][l] - x_[1], dz = y[2][l] - x_[2];
            const Lanes rr = dx * dx + dy * dy + dz * dz;
            const Lanes K = mask(visible, l) / (rr * rr);
            for (std::size_t band = 0; band < bands; ++band) arrived[band] += K * light[band][l];
        }
        for (std::size_t band = 0; band < bands; ++band) sum_[band] += there * arrived[band];
        if constexpr (Layout::has_rest) add_rest(q, D, y, light, scale, visible);
    }

    /// Adds a link with an integrated block.
    EXITANCE_INLINE void add(const float* block, const NodalField& b, ElementId q) {
        for (std::size_t band = 0; band < bands; ++band) {
            const float* const light = b.at(q, band);
            Lanes arrived{};
            for (std::size_t l = 0; l < n; ++l) arrived += load<lanes>(block + l * lanes) * light[l];
            sum_[band] += arrived;
            if constexpr (Layout::has_rest)
                for (std::size_t l = 0; l < n; ++l) rest_sum_[band] += block[lanes * n + l] * light[l];
        }
    }

    /// Moves the sums to double precision, before single precision loses accuracy.
    EXITANCE_INLINE void put_by() {
        for (std::size_t band = 0; band < bands; ++band) {
            for (std::size_t k = 0; k < lanes; ++k) total_[k][band] += static_cast<double>(sum_[band][k]);
            sum_[band] = Lanes{};
            if constexpr (Layout::has_rest) {
                double sum = static_cast<double>(rest_sum_[band]);
                for (std::size_t l = 0; l < lanes; ++l) sum += static_cast<double>(rest_lanes_[band][l]);
                total_[lanes][band] += sum;
                rest_lanes_[band] = Lanes{}, rest_sum_[band] = 0;
            }
        }
    }
    const NodalValues& total() const { return total_; }

  private:
    EXITANCE_INLINE static Lanes mask(const std::uint32_t* visible, std::size_t group) {
        const std::size_t bit = group * lanes;
        const std::uint32_t bits = visible[bit / 32] >> (bit % 32) & ((1u << lanes) - 1);
        return load<lanes>(lane_masks.of[bits]);
    }

    /// Computes the positions of the source's nodes relative to the receiver's centre, and the light that each emits
    /// towards the receiver's plane.
    EXITANCE_INLINE void send(const SourceRecord<n>& q, const float (&D)[3], float (&y)[3][n],
                              float (&light)[bands][n]) const {
        Lanes here{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Lanes at = D[axis] + load<lanes>(q.node[axis]);
            here += normal_[axis] * at;
            __builtin_memcpy(y[axis], &at, sizeof at);
        }
        here = positive(here);
        for (std::size_t band = 0; band < bands; ++band) {
            const Lanes sent = here * load<lanes>(q.light[band]);
            __builtin_memcpy(light[band], &sent, sizeof sent);
        }
        if constexpr (Layout::has_rest) {
            float last = 0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                y[axis][lanes] = D[axis] + q.node[axis][lanes];
                last += normal_[axis] * y[axis][lanes];
            }
            last = std::max(0.0f, last);
            for (std::size_t band = 0; band < bands; ++band) light[band][lanes] = last * q.light[band][lanes];
        }
    }

    EXITANCE_INLINE void add_rest(const SourceRecord<n>& q, const float (&D)[3], const float (&y)[3][n],
                                  const float (&light)[bands][n], float scale, const std::uint32_t* visible) {
        float there = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) there += q.normal[axis] * (rest_[axis] - D[axis]);
        if (there <= 0) return;
        there *= scale;
        const Lanes dx = load<lanes>(y[0]) - rest_[0], dy = load<lanes>(y[1]) - rest_[1],
                    dz = load<lanes>(y[2]) - rest_[2];
        const Lanes rr = dx * dx + dy * dy + dz * dz;
        const Lanes K = there * mask(visible, n) / (rr * rr);
        constexpr std::size_t last_bit = lanes * n + lanes;
        const bool sees_last = visible[last_bit / 32] >> (last_bit % 32) & 1u;
        const float ex = y[0][lanes] - rest_[0], ey = y[1][lanes] - rest_[1], ez = y[2][lanes] - rest_[2];
        const float ss = ex * ex + ey * ey + ez * ez, last = sees_last ? there / (ss * ss) : 0;
        for (std::size_t band = 0; band < bands; ++band) {
            rest_lanes_[band] += K * load<lanes>(light[band]);
            rest_sum_[band] += last * light[band][lanes];
        }
    }

    Point centre_;
    double scale_;
    float normal_[3];
    Lanes x_[3];
    float rest_[3]{};
    Lanes sum_[bands]{}, rest_lanes_[bands]{};
    float rest_sum_[bands]{};
    NodalValues total_{};  ///< Sums over sources that are complete, to which put_by() adds.
};

/// Light of constant elements, padded to whole registers.
struct PaddedSpectrum {
    Floats<std::max<std::size_t>(4, std::bit_ceil(bands))> of{};
};

}  // namespace

template <class Row>
void Links::Rows::for_each(const ElementTree& tree, const Row& gather_row) const {
    parallel_for(receiver.size(), grain,
                 [&](std::size_t row) {
                     gather_row(row);
                     note_touched("links", first[row + 1] - first[row]);
                 },
                 {"gather links", [&](std::size_t row) { return tree.region(receiver[row]).value; }, true});
}

/// Uses several independent sums, because a single one would wait for the previous addition at every step. Sums are in
/// single precision for some links, then in double.
void Links::gather_constants(const NodalField& b, NodalField& E) const {
    constexpr std::size_t ways = 8, at_a_time = 256, ahead = 512;
    const std::vector<ElementId>&receiver = constants_.receiver, &sources = constants_.sources;
    const std::vector<std::size_t>& first = constants_.first;
    const std::vector<std::uint32_t>& source = constants_.source;
    std::vector<PaddedSpectrum> light(sources.size());
    parallel_for(light.size(), 4096, [&](std::size_t i) {
        const Spectrum mean = b.mean(sources[i]);
        for (std::size_t band = 0; band < bands; ++band) light[i].of[band] = static_cast<float>(mean[band]);
    });
    constants_.for_each(sites_->tree(), [&](std::size_t row) {
        Spectrum total;
        const auto term = [&](std::size_t i) { return factor_[i] * light[source[i]].of; };
        for (std::size_t i = first[row]; i < first[row + 1];) {
            const std::size_t end = std::min(i + at_a_time, first[row + 1]);
            decltype(PaddedSpectrum::of) sum[ways]{};
            for (; i + ways <= end; i += ways) {
                __builtin_prefetch(&source[i] + ahead);
                __builtin_prefetch(&factor_[i] + ahead);
                for (std::size_t way = 0; way < ways; ++way) sum[way] += term(i + way);
            }
            for (; i < end; ++i) sum[0] += term(i);
            const auto all = ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
            for (std::size_t band = 0; band < bands; ++band) total[band] += static_cast<double>(all[band]);
        }
        NodalValues alike{};
        for (std::size_t k = 0; k < sites_->nodes(); ++k)
            if (sites_->weight(receiver[row], k) > 0) alike[k] = total;
        E.add(receiver[row], alike);
    });
}

template <class Layout>
void Links::gather_kernels(const NodalField& b, NodalField& E) const {
    constexpr std::size_t at_a_time = 16, ahead = 3;  // number of links: per single-precision sum; to prefetch
    const double scale = 1 / std::sqrt(sites_->stage().area);
    const std::vector<ElementId>&receiver = kernels_.receiver, &sources = kernels_.sources;
    const std::vector<std::size_t>& first = kernels_.first;
    const std::vector<std::uint32_t>& source = kernels_.source;
    // Memory is left uninitialized here, so that the threads that fill it also touch it first.
    const auto records = std::make_unique_for_overwrite<SourceRecord<Layout::n>[]>(sources.size());
    parallel_for(sources.size(), 256, [&](std::size_t i) { fill(records[i], *sites_, b, sources[i], scale); });
    kernels_.for_each(sites_->tree(), [&](std::size_t row) {
        ReceivedLight<Layout> light(*sites_, receiver[row], scale);
        call_for_four([&]() EXITANCE_INLINE_LAMBDA {
            for (std::size_t i = first[row]; i < first[row + 1]; ++i) {
                prefetch(records[source[std::min(i + ahead, source.size() - 1)]]);
                if (Link::is_far(block_[i]))
                    light.add(records[source[i]], Link::scale(block_[i]), &visible_[i * words_]);
                else
                    light.add(&blocks_[block_[i]], b, sources[source[i]]);
                if (i % at_a_time == 0) light.put_by();
            }
            light.put_by();
        });
        E.add(receiver[row], light.total());
    });
}

void Links::gather(const NodalField& b, NodalField& E) const {
    E.clear();
    add_to(E, b);
}

void Links::add_to(NodalField& E, const NodalField& b) const {
    gather_constants(b, E);
    if (sites_->nodes() == 4) gather_kernels<LinkLayout2>(b, E);
    if (sites_->nodes() == 9) gather_kernels<LinkLayout3>(b, E);
}

}  // namespace exitance
