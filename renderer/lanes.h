// Lanes: x, y and z side by side in vector registers, the last lane unused (vectors of GCC and
// Clang, as Spectrum's). For what is done at every bounce; the arithmetic is that of scalars, to
// the bit.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#ifdef __AVX__
#include <immintrin.h>
#endif

#include "renderer/vec.h"

namespace etendue {

using FloatLanes = float __attribute__((vector_size(16)));
using IntLanes = std::int32_t __attribute__((vector_size(16)));
using DoubleLanes = double __attribute__((vector_size(32)));

inline FloatLanes lanesOf(Vec3 v) { return FloatLanes{v.x, v.y, v.z, 0.0f}; }
inline Vec3 vecOf(FloatLanes v) { return {v[0], v[1], v[2]}; }
inline Vec3d vecOf(DoubleLanes v) { return {v[0], v[1], v[2]}; }

/// Of a vector in memory. GCC 12 would go by way of the stack.
inline FloatLanes loadLanes(const Vec3& v) {
#ifdef __AVX__
    const __m128 xy = _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(&v)));
    return _mm_insert_ps(xy, _mm_load_ss(&v.z), 0x20);
#else
    return lanesOf(v);
#endif
}

inline DoubleLanes loadLanes(const Vec3d& v) {
#ifdef __AVX__
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(&v.x)), _mm_load_sd(&v.z), 1);
#else
    return DoubleLanes{v.x, v.y, v.z, 0.0};
#endif
}

// GCC 12 converts generic vectors half by half.
inline DoubleLanes toDouble(FloatLanes v) {
#ifdef __AVX__
    return _mm256_cvtps_pd(v);
#else
    return __builtin_convertvector(v, DoubleLanes);
#endif
}
inline FloatLanes toFloat(DoubleLanes v) {
#ifdef __AVX__
    return _mm256_cvtpd_ps(v);
#else
    return __builtin_convertvector(v, FloatLanes);
#endif
}

inline DoubleLanes normalize(DoubleLanes v) {
    const DoubleLanes squares = v * v;
    return v * (1.0 / std::sqrt(squares[0] + squares[1] + squares[2]));
}
inline DoubleLanes abs(DoubleLanes v) {
    using Bits = std::int64_t __attribute__((vector_size(32)));
    return std::bit_cast<DoubleLanes>(std::bit_cast<Bits>(v) &
                                      std::numeric_limits<std::int64_t>::max());
}
inline DoubleLanes max(DoubleLanes a, DoubleLanes b) { return a < b ? b : a; }

inline DoubleLanes cross(DoubleLanes a, DoubleLanes b) {
    const DoubleLanes aNext = __builtin_shufflevector(a, a, 1, 2, 0, 3),
                      aLast = __builtin_shufflevector(a, a, 2, 0, 1, 3),
                      bNext = __builtin_shufflevector(b, b, 1, 2, 0, 3),
                      bLast = __builtin_shufflevector(b, b, 2, 0, 1, 3);
    return aNext * bLast - aLast * bNext;
}

}  // namespace etendue
