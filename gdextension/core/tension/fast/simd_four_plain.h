// Four doubles in two 16-byte vectors (SSE2 or NEON), with the operations of simd_four_avx2.h. A
// mask has all bits of a lane set or none.
#pragma once

namespace spidar {

namespace { // one copy per source, for its own target

class FourPlain {
    typedef double Pair __attribute__((vector_size(16)));
    typedef double LoosePair __attribute__((vector_size(16), aligned(8), may_alias));
    typedef long long Bits __attribute__((vector_size(16)));

public:
    static FourPlain load(const double *p) noexcept {
        return {*reinterpret_cast<const LoosePair *>(p),
                *reinterpret_cast<const LoosePair *>(p + 2)};
    }
    void store(double *p) const noexcept {
        *reinterpret_cast<LoosePair *>(p) = a_;
        *reinterpret_cast<LoosePair *>(p + 2) = b_;
    }
    static FourPlain all(double v) noexcept { return {Pair{v, v}, Pair{v, v}}; }

    friend FourPlain operator+(FourPlain x, FourPlain y) noexcept {
        return {x.a_ + y.a_, x.b_ + y.b_};
    }
    friend FourPlain operator-(FourPlain x, FourPlain y) noexcept {
        return {x.a_ - y.a_, x.b_ - y.b_};
    }
    friend FourPlain operator*(FourPlain x, FourPlain y) noexcept {
        return {x.a_ * y.a_, x.b_ * y.b_};
    }
    friend FourPlain operator/(FourPlain x, FourPlain y) noexcept {
        return {x.a_ / y.a_, x.b_ / y.b_};
    }
    // Returns x y + z.
    static FourPlain mul_add(FourPlain x, FourPlain y, FourPlain z) noexcept { return x * y + z; }
    // Returns z - x y.
    static FourPlain sub_mul(FourPlain x, FourPlain y, FourPlain z) noexcept { return z - x * y; }
    friend FourPlain operator&(FourPlain x, FourPlain y) noexcept {
        return {Pair(Bits(x.a_) & Bits(y.a_)), Pair(Bits(x.b_) & Bits(y.b_))};
    }
    friend FourPlain operator<(FourPlain x, FourPlain y) noexcept {
        return {Pair(x.a_ < y.a_), Pair(x.b_ < y.b_)};
    }
    friend FourPlain operator<=(FourPlain x, FourPlain y) noexcept {
        return {Pair(x.a_ <= y.a_), Pair(x.b_ <= y.b_)};
    }
    static FourPlain select(FourPlain mask, FourPlain yes, FourPlain no) noexcept {
        const Bits ma = Bits(mask.a_);
        const Bits mb = Bits(mask.b_);
        return {Pair((ma & Bits(yes.a_)) | (~ma & Bits(no.a_))),
                Pair((mb & Bits(yes.b_)) | (~mb & Bits(no.b_)))};
    }
    [[nodiscard]] FourPlain absolute() const noexcept {
        const Bits sign = {0x7FFFFFFFFFFFFFFF, 0x7FFFFFFFFFFFFFFF};
        return {Pair(Bits(a_) & sign), Pair(Bits(b_) & sign)};
    }
    // Returns y in lanes where either is NaN.
    static FourPlain max(FourPlain x, FourPlain y) noexcept {
        return {x.a_ > y.a_ ? x.a_ : y.a_, x.b_ > y.b_ ? x.b_ : y.b_};
    }
    static FourPlain min(FourPlain x, FourPlain y) noexcept {
        return {x.a_ < y.a_ ? x.a_ : y.a_, x.b_ < y.b_ ? x.b_ : y.b_};
    }
    // Returns one bit per lane of a mask.
    [[nodiscard]] unsigned bits() const noexcept {
#if defined(__SSE2__)
        return static_cast<unsigned>(__builtin_ia32_movmskpd(a_) |
                                     (__builtin_ia32_movmskpd(b_) << 2));
#else
        const Bits a = Bits(a_);
        const Bits b = Bits(b_);
        return static_cast<unsigned>((a[0] & 1) | (a[1] & 2) | (b[0] & 4) | (b[1] & 8));
#endif
    }
    template <int kLane>
    [[nodiscard]] FourPlain lane() const noexcept {
        const double v = kLane < 2 ? a_[kLane & 1] : b_[kLane & 1];
        return all(v);
    }
    // Returns a copy with the first lanes of x and y in lanes kLane and kLane + 1 (kLane: 0 or 2).
    template <int kLane>
    [[nodiscard]] FourPlain with_pair(FourPlain x, FourPlain y) const noexcept {
        const Pair pair = {x.a_[0], y.a_[0]};
        return kLane == 0 ? FourPlain{pair, b_} : FourPlain{a_, pair};
    }
    // Returns a copy with lanes kLane and kLane + 1 zero.
    template <int kLane>
    [[nodiscard]] FourPlain without_pair() const noexcept {
        return kLane == 0 ? FourPlain{Pair{}, b_} : FourPlain{a_, Pair{}};
    }
    // Returns a copy with lane kLane taken from x.
    template <int kLane>
    [[nodiscard]] FourPlain with_lane(FourPlain x) const noexcept {
        FourPlain made = *this;
        (kLane < 2 ? made.a_ : made.b_)[kLane & 1] = (kLane < 2 ? x.a_ : x.b_)[kLane & 1];
        return made;
    }
    static void load_transposed(const double *p0, const double *p1, const double *p2,
                                const double *p3, FourPlain &r0, FourPlain &r1, FourPlain &r2,
                                FourPlain &r3) noexcept {
        r0 = load(p0);
        r1 = load(p1);
        r2 = load(p2);
        r3 = load(p3);
        transpose(r0, r1, r2, r3);
    }
    static void transpose(FourPlain &r0, FourPlain &r1, FourPlain &r2, FourPlain &r3) noexcept {
        const FourPlain c0{Pair{r0.a_[0], r1.a_[0]}, Pair{r2.a_[0], r3.a_[0]}};
        const FourPlain c1{Pair{r0.a_[1], r1.a_[1]}, Pair{r2.a_[1], r3.a_[1]}};
        const FourPlain c2{Pair{r0.b_[0], r1.b_[0]}, Pair{r2.b_[0], r3.b_[0]}};
        const FourPlain c3{Pair{r0.b_[1], r1.b_[1]}, Pair{r2.b_[1], r3.b_[1]}};
        r0 = c0;
        r1 = c1;
        r2 = c2;
        r3 = c3;
    }
    [[nodiscard]] double largest() const noexcept {
        const Pair m = a_ > b_ ? a_ : b_;
        return m[0] > m[1] ? m[0] : m[1];
    }
    [[nodiscard]] double sum() const noexcept {
        const Pair m = a_ + b_;
        return m[0] + m[1];
    }
    [[nodiscard]] double first() const noexcept {
        return a_[0];
    }

    FourPlain() noexcept = default;

private:
    FourPlain(Pair a, Pair b) noexcept : a_(a), b_(b) {}
    Pair a_{};
    Pair b_{};
};

} // namespace

} // namespace spidar
