// Eight doubles, one a string, in one 64-byte vector with fused multiply-add. Masks are bits, bit i for lane i. For
// sources compiled for AVX-512 F and DQ only.
#pragma once

#include <immintrin.h>

namespace spidar {

namespace { // each source compiles its own, for its own target

class EightAvx512 {
public:
    static EightAvx512 load(const double *p) noexcept { return _mm512_loadu_pd(p); }
    void store(double *p) const noexcept { _mm512_storeu_pd(p, v_); }
    static EightAvx512 all(double v) noexcept { return _mm512_set1_pd(v); }
    // The first kLanes, zero above.
    template <int kLanes>
    static EightAvx512 load_front(const double *p) noexcept {
        return _mm512_maskz_loadu_pd((1U << kLanes) - 1U, p);
    }

    EightAvx512 operator+(EightAvx512 y) const noexcept { return _mm512_add_pd(v_, y.v_); }
    EightAvx512 operator-(EightAvx512 y) const noexcept { return _mm512_sub_pd(v_, y.v_); }
    EightAvx512 operator*(EightAvx512 y) const noexcept { return _mm512_mul_pd(v_, y.v_); }
    // x y + z, z - x y
    static EightAvx512 mul_add(EightAvx512 x, EightAvx512 y, EightAvx512 z) noexcept {
        return _mm512_fmadd_pd(x.v_, y.v_, z.v_);
    }
    static EightAvx512 sub_mul(EightAvx512 x, EightAvx512 y, EightAvx512 z) noexcept {
        return _mm512_fnmadd_pd(x.v_, y.v_, z.v_);
    }
    static unsigned less(EightAvx512 x, EightAvx512 y) noexcept {
        return _mm512_cmp_pd_mask(x.v_, y.v_, _CMP_LT_OQ);
    }
    static unsigned less_equal(EightAvx512 x, EightAvx512 y) noexcept {
        return _mm512_cmp_pd_mask(x.v_, y.v_, _CMP_LE_OQ);
    }
    static EightAvx512 select(unsigned mask, EightAvx512 yes, EightAvx512 no) noexcept {
        return _mm512_mask_mov_pd(no.v_, static_cast<__mmask8>(mask), yes.v_);
    }
    // Zero outside the mask.
    [[nodiscard]] EightAvx512 keep(unsigned mask) const noexcept {
        return _mm512_maskz_mov_pd(static_cast<__mmask8>(mask), v_);
    }
    [[nodiscard]] EightAvx512 absolute() const noexcept { return _mm512_abs_pd(v_); }
    static EightAvx512 max(EightAvx512 x, EightAvx512 y) noexcept {
        return _mm512_max_pd(x.v_, y.v_);
    }
    static EightAvx512 min(EightAvx512 x, EightAvx512 y) noexcept {
        return _mm512_min_pd(x.v_, y.v_);
    }
    template <int kLane>
    [[nodiscard]] EightAvx512 lane() const noexcept {
        return _mm512_permutexvar_pd(_mm512_set1_epi64(kLane), v_);
    }
    [[nodiscard]] double first() const noexcept { return _mm512_cvtsd_f64(v_); }
    [[nodiscard]] double largest() const noexcept {
        const __m256d m = _mm256_max_pd(_mm512_castpd512_pd256(v_), _mm512_extractf64x4_pd(v_, 1));
        const __m128d n = _mm_max_pd(_mm256_castpd256_pd128(m), _mm256_extractf128_pd(m, 1));
        return _mm_cvtsd_f64(_mm_max_sd(n, _mm_unpackhi_pd(n, n)));
    }
    [[nodiscard]] double sum() const noexcept {
        const __m256d m = _mm256_add_pd(_mm512_castpd512_pd256(v_), _mm512_extractf64x4_pd(v_, 1));
        const __m128d n = _mm_add_pd(_mm256_castpd256_pd128(m), _mm256_extractf128_pd(m, 1));
        return _mm_cvtsd_f64(_mm_add_sd(n, _mm_unpackhi_pd(n, n)));
    }
    // Rows become columns.
    static void transpose(EightAvx512 (&r)[8]) noexcept {
        const __m512d a0 = _mm512_unpacklo_pd(r[0].v_, r[1].v_); // 00 10 02 12 04 14 06 16
        const __m512d a1 = _mm512_unpackhi_pd(r[0].v_, r[1].v_);
        const __m512d a2 = _mm512_unpacklo_pd(r[2].v_, r[3].v_);
        const __m512d a3 = _mm512_unpackhi_pd(r[2].v_, r[3].v_);
        const __m512d a4 = _mm512_unpacklo_pd(r[4].v_, r[5].v_);
        const __m512d a5 = _mm512_unpackhi_pd(r[4].v_, r[5].v_);
        const __m512d a6 = _mm512_unpacklo_pd(r[6].v_, r[7].v_);
        const __m512d a7 = _mm512_unpackhi_pd(r[6].v_, r[7].v_);
        transpose_pairs(a0, a2, a4, a6, r[0], r[2], r[4], r[6]);
        transpose_pairs(a1, a3, a5, a7, r[1], r[3], r[5], r[7]);
    }

    EightAvx512() noexcept = default;

private:
    // Four vectors of four pairs each, rows to columns.
    static void transpose_pairs(__m512d a, __m512d b, __m512d c, __m512d d, EightAvx512 &r0,
                                EightAvx512 &r1, EightAvx512 &r2, EightAvx512 &r3) noexcept {
        const __m512d ab_even = _mm512_shuffle_f64x2(a, b, 0x88); // a0 a2 b0 b2
        const __m512d ab_odd = _mm512_shuffle_f64x2(a, b, 0xDD);
        const __m512d cd_even = _mm512_shuffle_f64x2(c, d, 0x88);
        const __m512d cd_odd = _mm512_shuffle_f64x2(c, d, 0xDD);
        r0 = _mm512_shuffle_f64x2(ab_even, cd_even, 0x88);
        r1 = _mm512_shuffle_f64x2(ab_odd, cd_odd, 0x88);
        r2 = _mm512_shuffle_f64x2(ab_even, cd_even, 0xDD);
        r3 = _mm512_shuffle_f64x2(ab_odd, cd_odd, 0xDD);
    }

    EightAvx512(__m512d v) noexcept
        : v_(v) {} // NOLINT: implicit, so that each line above is one operation
    __m512d v_ = _mm512_setzero_pd();
};

} // namespace

} // namespace spidar
