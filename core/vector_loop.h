/// Loops that the compiler vectorises for more than one processor.
///
/// A function marked TARMAC_VECTOR_LOOP is compiled twice, for the processor that every build supports and for AVX2;
/// the program picks one when it starts. Both give the same bits: every operation is rounded by itself (no fused
/// multiply-add, no reordering), however many lanes run side by side. Such a function holds plain loops over arrays and
/// calls nothing but inline arithmetic; keep Eigen and the standard library's templates out of it.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define TARMAC_VECTOR_LOOP __attribute__((target_clones("avx2", "default")))
#else
#define TARMAC_VECTOR_LOOP
#endif
