//! Words that a mechanism cannot be called in C.

use crate::runtime;
use std::borrow::Cow;

/// A mechanism's name as C, C++ and JavaScript can have it: with `_mechanism` behind it where it is a word of theirs or
/// means something else in a header or in the run time. All other names in C begin with it, so that none of them is
/// such a word.
pub fn c_name(name: &str) -> Cow<'_, str> {
    let is_listed = |name: &str| WORDS.iter().any(|words| words.split(' ').any(|word| word == name));
    // Functions for other precisions, re-entrant ones and the like; and types.
    let mut variants = ["", "f", "l", "_r", "_l", "_unlocked"].into_iter();
    let is_variant = variants.any(|ending| name.strip_suffix(ending).is_some_and(is_listed));
    if is_variant || name.ends_with("_t") || runtime::mentions(name) {
        format!("{name}_mechanism").into()
    } else {
        name.into()
    }
}

/// Those in lower case; words of Rust are none of them, which no model file may have as a name.
const WORDS: [&str; 7] = [
    // C, and what compilers add to it.
    "alignas alignof and and_eq asm auto bitand bitor bool case char complex compl constexpr default double float goto \
     huge imaginary inline int linux long near noreturn not not_eq nullptr or or_eq register restrict short signed \
     sizeof static_assert switch thread_local typeof_unqual union unix unsigned void volatile xor xor_eq",
    // C++.
    "catch class co_await co_return co_yield concept consteval constinit const_cast decltype delete dynamic_cast explicit \
     export friend import module mutable namespace new noexcept operator private protected public reinterpret_cast \
     requires static_cast std template this throw typedef typeid typename using",
    // JavaScript.
    "arguments constructor debugger eval finally function implements instanceof interface null package prototype \
     undefined var with",
    // <math.h> and <complex.h>, without the names for other precisions.
    "acos acosh asin asinh atan atan2 atanh cabs cacos cacosh carg casin casinh catan catanh cbrt ccos ccosh ceil cexp \
     cimag clog conj copysign cos cosh cpow cproj creal csin csinh csqrt ctan ctanh drem erf erfc exp exp10 exp2 expm1 \
     fabs fdim finite floor fma fmax fmin fmod fpclassify frexp gamma hypot ilogb isfinite isgreater isgreaterequal \
     isinf isless islessequal islessgreater isnan isnormal isunordered j0 j1 jn ldexp lgamma llrint llround log log10 \
     log1p log2 logb lrint lround modf nan nearbyint nextafter nexttoward pow pow10 remainder remquo rint round scalb \
     scalbln scalbn signbit signgam significand sin sinh sqrt tan tanh tgamma trunc y0 y1 yn",
    // <stdlib.h>, <string.h>, <stdio.h>, <ctype.h>, <time.h>, <signal.h>, <unistd.h>.
    "a64l abort abs alarm aligned_alloc alloca arc4random arc4random_buf arc4random_uniform asctime assert \
     at_quick_exit atexit atof atoi atol bcmp bcopy bsearch bzero calloc clearenv clearerr clock \
     clock_getcpuclockid clock_getres clock_gettime clock_nanosleep clock_settime close ctermid ctime daylight \
     difftime div dprintf drand48 dysize ecvt erand48 errno exit explicit_bzero fclose fcvt fd_mask fd_set fdopen \
     feof ferror fflush ffs ffsll fgetc fgetpos fgets fileno flockfile fmemopen fopen fork fprintf fputc fputs \
     fread free freopen fscanf fseek fseeko fsetpos ftell ftello ftrylockfile funlockfile fwrite gcvt getc getchar \
     getdelim getenv getline getloadavg getsubopt getw gmtime gsignal index initstate isalnum isalpha isblank \
     iscntrl isdigit isgraph islower isprint ispunct isspace isupper isxdigit jrand48 kill killpg l64a labs \
     lcong48 ldiv lgammaf_r lgammal_r link llabs lldiv localtime longjmp lrand48 main malloc math_errhandling \
     mblen mbstowcs mbtowc memccpy memchr memcmp memcpy memmove memset mkdtemp mkstemp mkstemps mktemp mktime \
     mrand48 nanosleep nrand48 offsetof on_exit open open_memstream pause pclose perror pipe popen posix_memalign \
     printf pselect psiginfo psignal pthread_kill pthread_sigmask putc putchar putenv puts putw qecvt qfcvt qgcvt \
     qsort quick_exit raise rand random read realloc reallocarray realpath remove rename renameat rewind rindex \
     rpmatch scanf seed48 select setbuf setbuffer setenv setjmp setlinebuf setstate setvbuf sigaction sigaddset \
     sigaltstack sigblock sigdelset sigemptyset sigfillset siggetmask siginterrupt sigismember signal sigpending \
     sigprocmask sigqueue sigreturn sigsetmask sigstack sigsuspend sigtimedwait sigwait sigwaitinfo sleep snprintf \
     sprintf srand srand48 srandom sscanf ssignal stderr stdin stdout stpcpy stpncpy strcasecmp strcat strchr \
     strcmp strcoll strcpy strcspn strdup strerror strftime strlen strncasecmp strncat strncmp strncpy strndup \
     strnlen strpbrk strrchr strsep strsignal strspn strstr strtod strtof strtok strtol strtold strtoq strtoul \
     strtouq strxfrm swab sync system tempnam time timegm timelocal timer_create timer_delete timer_getoverrun \
     timer_gettime timer_settime times timespec_get timezone tmpfile tmpnam tolower toupper truncate tzset u_char \
     u_int u_long u_short uint ulong ungetc unsetenv ushort va_arg va_copy va_end va_list va_start valloc vdprintf \
     vfprintf vfscanf vprintf vscanf vsnprintf vsprintf vsscanf wait wcstombs wctomb write",
    // Headers, and what would give its constants the names of macros: `X_OK`.
    "around ctype float fmi3 limits math setjmp stdarg stdbool stddef stdint stdio stdlib string f r w x",
    // What the run time calls something else.
    "begin condition derive drift forget instance instantiate mechanism multiply observe phase refuse report s \
     slopes",
];
