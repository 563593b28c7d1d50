// Pack: numbers side by side in vector registers, with an exactly rounded multiply-add, so that the
// same bits come from every compiler and every width. All of it is inlined, however large the
// function around it: a call would send registers through memory.
//
// Code for wider registers than the rest of the program may use includes this file, too. It must
// not share an inline function with that rest, of which a linker keeps any one: the width is part
// of every type's name, and functions of the standard library are not called.
#pragma once

#include <cstring>
#include <type_traits>
#ifdef __FMA__
#include <immintrin.h>
#endif

namespace etendue {

/// T is float or double; N and RegisterBytes are powers of two.
template <class T, int N, int RegisterBytes = 32>
class Pack {
public:
    using Scalar = T;
    static constexpr int lanes = N, registerBytes = RegisterBytes;

    [[gnu::always_inline]] static Pack load(const T* from) {
        Pack result;
        std::memcpy(result.registers_, from, sizeof(result.registers_));
        return result;
    }
    [[gnu::always_inline]] static Pack all(T value) {
        Pack result;
        for (Register& r : result.registers_) r = Register{} + value;
        return result;
    }
    [[gnu::always_inline]] void store(T* to) const {
        std::memcpy(to, registers_, sizeof(registers_));
    }
    /// Four lanes with their halves exchanged.
    [[gnu::always_inline]] Pack exchanged() const {
        static_assert(N == 4);
        Pack result;
        result.registers_[0] = __builtin_shufflevector(registers_[0], registers_[0], 2, 3, 0, 1);
        return result;
    }
    [[gnu::always_inline]] T operator[](int lane) const {
        return registers_[lane / width][lane % width];
    }

    [[gnu::always_inline]] friend Pack operator+(const Pack& a, const Pack& b) {
        Pack result;
        for (int i = 0; i < count; ++i) result.registers_[i] = a.registers_[i] + b.registers_[i];
        return result;
    }
    [[gnu::always_inline]] friend Pack operator*(const Pack& a, const Pack& b) {
        Pack result;
        for (int i = 0; i < count; ++i) result.registers_[i] = a.registers_[i] * b.registers_[i];
        return result;
    }
    [[gnu::always_inline]] friend Pack operator/(const Pack& a, const Pack& b) {
        Pack result;
        for (int i = 0; i < count; ++i) result.registers_[i] = a.registers_[i] / b.registers_[i];
        return result;
    }
    /// a b + c, rounded once.
    [[gnu::always_inline]] friend Pack fma(const Pack& a, const Pack& b, const Pack& c) {
        Pack result;
        for (int i = 0; i < count; ++i)
            result.registers_[i] = fused(a.registers_[i], b.registers_[i], c.registers_[i]);
        return result;
    }

private:
    static constexpr int fitting = RegisterBytes / static_cast<int>(sizeof(T));
    static constexpr int width = N < fitting ? N : fitting;
    static constexpr int count = N / width;
    typedef T Register __attribute__((vector_size(width * sizeof(T))));

    [[gnu::always_inline]] static Register fused(Register a, Register b, Register c) {
#ifdef __AVX512F__
        if constexpr (std::is_same_v<T, double> && width == 8) return _mm512_fmadd_pd(a, b, c);
        if constexpr (std::is_same_v<T, float> && width == 16) return _mm512_fmadd_ps(a, b, c);
#endif
#ifdef __FMA__  // as the loop below, which GCC 12 does not see through everywhere
        if constexpr (std::is_same_v<T, double> && width == 4) return _mm256_fmadd_pd(a, b, c);
        if constexpr (std::is_same_v<T, float> && width == 8) return _mm256_fmadd_ps(a, b, c);
        if constexpr (std::is_same_v<T, float> && width == 4) return _mm_fmadd_ps(a, b, c);
#endif
        Register result;
        for (int lane = 0; lane < width; ++lane) {
            if constexpr (std::is_same_v<T, float>)
                result[lane] = __builtin_fmaf(a[lane], b[lane], c[lane]);
            else
                result[lane] = __builtin_fma(a[lane], b[lane], c[lane]);
        }
        return result;
    }

    Register registers_[count];
};

}  // namespace etendue
