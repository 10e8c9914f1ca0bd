// Four doubles in one 32-byte vector with fused multiply-add, for sources compiled for AVX2 and
// FMA. The operations are documented in simd_four_plain.h.
#pragma once

#include <immintrin.h>

namespace spidar {

namespace { // one copy per source, for its own target

class FourAvx2 {
public:
    static FourAvx2 load(const double *p) noexcept { return _mm256_loadu_pd(p); }
    void store(double *p) const noexcept { _mm256_storeu_pd(p, v_); }
    static FourAvx2 all(double v) noexcept { return _mm256_set1_pd(v); }

    FourAvx2 operator+(FourAvx2 y) const noexcept { return _mm256_add_pd(v_, y.v_); }
    FourAvx2 operator-(FourAvx2 y) const noexcept { return _mm256_sub_pd(v_, y.v_); }
    FourAvx2 operator*(FourAvx2 y) const noexcept { return _mm256_mul_pd(v_, y.v_); }
    FourAvx2 operator/(FourAvx2 y) const noexcept { return _mm256_div_pd(v_, y.v_); }
    static FourAvx2 mul_add(FourAvx2 x, FourAvx2 y, FourAvx2 z) noexcept {
        return _mm256_fmadd_pd(x.v_, y.v_, z.v_);
    }
    static FourAvx2 sub_mul(FourAvx2 x, FourAvx2 y, FourAvx2 z) noexcept {
        return _mm256_fnmadd_pd(x.v_, y.v_, z.v_);
    }
    FourAvx2 operator&(FourAvx2 y) const noexcept { return _mm256_and_pd(v_, y.v_); }
    FourAvx2 operator<(FourAvx2 y) const noexcept { return _mm256_cmp_pd(v_, y.v_, _CMP_LT_OQ); }
    FourAvx2 operator<=(FourAvx2 y) const noexcept { return _mm256_cmp_pd(v_, y.v_, _CMP_LE_OQ); }
    // Not blendv: it takes three micro-operations, and gcc adds a compare.
    static FourAvx2 select(FourAvx2 mask, FourAvx2 yes, FourAvx2 no) noexcept {
        return _mm256_or_pd(_mm256_and_pd(mask.v_, yes.v_), _mm256_andnot_pd(mask.v_, no.v_));
    }
    [[nodiscard]] FourAvx2 absolute() const noexcept {
        return _mm256_andnot_pd(_mm256_set1_pd(-0.0), v_);
    }
    static FourAvx2 max(FourAvx2 x, FourAvx2 y) noexcept { return _mm256_max_pd(x.v_, y.v_); }
    static FourAvx2 min(FourAvx2 x, FourAvx2 y) noexcept { return _mm256_min_pd(x.v_, y.v_); }
    [[nodiscard]] unsigned bits() const noexcept {
        return static_cast<unsigned>(_mm256_movemask_pd(v_));
    }
    template <int kLane>
    [[nodiscard]] FourAvx2 lane() const noexcept {
        return _mm256_permute4x64_pd(v_, kLane * 0x55);
    }
    template <int kLane>
    [[nodiscard]] FourAvx2 with_pair(FourAvx2 x, FourAvx2 y) const noexcept {
        const __m256d one = _mm256_blend_pd(v_, x.v_, 1 << kLane);
        return _mm256_blend_pd(one, y.v_, 2 << kLane);
    }
    template <int kLane>
    [[nodiscard]] FourAvx2 without_pair() const noexcept {
        return _mm256_blend_pd(v_, _mm256_setzero_pd(), 3 << kLane);
    }
    template <int kLane>
    [[nodiscard]] FourAvx2 with_lane(FourAvx2 x) const noexcept {
        return _mm256_blend_pd(v_, x.v_, 1 << kLane);
    }
    // Loads the transpose of the four rows without the shuffles that loads can replace.
    static void load_transposed(const double *p0, const double *p1, const double *p2,
                                const double *p3, FourAvx2 &r0, FourAvx2 &r1, FourAvx2 &r2,
                                FourAvx2 &r3) noexcept {
        const __m256d front02 = two_pairs(p0, p2);
        const __m256d front13 = two_pairs(p1, p3);
        const __m256d back02 = two_pairs(p0 + 2, p2 + 2);
        const __m256d back13 = two_pairs(p1 + 2, p3 + 2);
        r0 = _mm256_unpacklo_pd(front02, front13);
        r1 = _mm256_unpackhi_pd(front02, front13);
        r2 = _mm256_unpacklo_pd(back02, back13);
        r3 = _mm256_unpackhi_pd(back02, back13);
    }
    static void transpose(FourAvx2 &r0, FourAvx2 &r1, FourAvx2 &r2, FourAvx2 &r3) noexcept {
        const __m256d even01 = _mm256_unpacklo_pd(r0.v_, r1.v_);
        const __m256d odd01 = _mm256_unpackhi_pd(r0.v_, r1.v_);
        const __m256d even23 = _mm256_unpacklo_pd(r2.v_, r3.v_);
        const __m256d odd23 = _mm256_unpackhi_pd(r2.v_, r3.v_);
        r0 = _mm256_permute2f128_pd(even01, even23, 0x20);
        r1 = _mm256_permute2f128_pd(odd01, odd23, 0x20);
        r2 = _mm256_permute2f128_pd(even01, even23, 0x31);
        r3 = _mm256_permute2f128_pd(odd01, odd23, 0x31);
    }
    [[nodiscard]] double largest() const noexcept {
        const __m128d m = _mm_max_pd(_mm256_castpd256_pd128(v_), _mm256_extractf128_pd(v_, 1));
        return _mm_cvtsd_f64(_mm_max_sd(m, _mm_unpackhi_pd(m, m)));
    }
    [[nodiscard]] double sum() const noexcept {
        const __m128d m = _mm_add_pd(_mm256_castpd256_pd128(v_), _mm256_extractf128_pd(v_, 1));
        return _mm_cvtsd_f64(_mm_add_sd(m, _mm_unpackhi_pd(m, m)));
    }
    [[nodiscard]] double first() const noexcept { return _mm256_cvtsd_f64(v_); }

    FourAvx2() noexcept = default;

private:
    static __m256d two_pairs(const double *low, const double *high) noexcept {
        return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(low)), _mm_loadu_pd(high),
                                    1);
    }
    FourAvx2(__m256d v) noexcept
        : v_(v) {} // NOLINT: implicit, so that each line above is one operation
    __m256d v_ = _mm256_setzero_pd();
};

} // namespace

} // namespace spidar
