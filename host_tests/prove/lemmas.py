"""What Eva, which knows one variable at a time, cannot see, as formulas that Z3 refutes.

Each lemma belongs to an assertion of the same name in the source: its hypotheses are what the code
computed before, its goal is the assertion. A lemma is a list of cases; each is a text of SMT-LIB 2
whose assertions (the hypotheses and the goal's negation) have to be unsatisfiable together. Integers
are the mathematical ones, and bounds that the code's types do not give are themselves goals.
"""
import subprocess


def declare(names, sort="Int"):
    return "".join(f"(declare-const {name} {sort})" for name in names.split())


def between(low, names, high):
    return "".join(f"(assert (<= {low} {name} {high}))" for name in names.split())


def case(logic, *parts):
    return f"(set-logic {logic})" + "".join(parts) + "(check-sat)"


def refuted(goal):
    return f"(assert (not {goal}))"


ROW_AT = "(define-fun row_at ((y Int)) Int (div (+ y 127) 256))"  # ew_row_at at 8 subpixel bits
CENTRE = "(define-fun centre ((row Int)) Int (+ (* 256 row) 128))"
LEAST = "(define-fun least ((a Int) (b Int)) Int (ite (< a b) a b))"
MOST = "(define-fun most ((a Int) (b Int)) Int (ite (< a b) b a))"
MAGNITUDE = "(define-fun magnitude ((a Int)) Int (ite (< a 0) (- a) a))"


def row_in_edge():
    """triangle.c orders corners by y and cuts rows by the scissor and `end`; an edge is only started on a
    row between its ends. The three calls of draw_rows, and those of ew_raster_keep and _draw_active, which
    start edges on the same rows."""
    placed = (ROW_AT + CENTRE + LEAST + MOST + declare("y0 y1 y2 top clip limit first end turn until") +
              "(assert (<= y0 y1 y2))" +
              "(assert (= first (most (row_at y0) clip)))(assert (= end (least (row_at y2) limit)))" +
              "(assert (< first end))(assert (= turn (most first (least (row_at y1) end))))" +
              "(assert (<= until end))")

    def call(guard, a, b, row):
        return case("QF_LIA", placed, f"(assert {guard})",
                    refuted(f"(and (<= 0 (- (centre {row}) {a})) (< (- (centre {row}) {a}) (- {b} {a})))"))

    # order(): compare and exchange (0 1), (1 2), (0 1)
    sort = (LEAST + MOST + declare("a b c") + "(define-fun p () Int (least a b))(define-fun q () Int (most a b))"
            "(define-fun bottom () Int (most q c))(define-fun r () Int (least q c))"
            "(define-fun top () Int (ite (< c q) (least p r) p))(define-fun middle () Int (ite (< c q) (most p r) r))")
    return [case("QF_LIA", sort, refuted("(and (<= top middle bottom) (= (+ top middle bottom) (+ a b c)))")),
            call("true", "y0", "y2", "first"),
            call("(< first (least turn until))", "y0", "y1", "first"),
            call("(< first turn)", "y0", "y1", "first"),
            call("(< (least turn until) until)", "y1", "y2", "(least turn until)"),
            call("(< turn until)", "y1", "y2", "turn")]


def between_corners():
    """Products of ew_edge_start, and one round of ew_udiv64_32: with `high` the remainder before the round,
    below d, and one more bit of n, quotient and remainder are again those of what was taken in so far. By
    induction over its rounds it returns floor(n / d) and n mod d; here n = s rise, rise < dy, s < dy."""
    # s |step| <= s (|dx| / dy + 1): with x = s step, dy x + s rise = s dx
    product = (declare("s dy dx step rise", "Real") + "(assert (<= 0 s (- dy 1)))(assert (<= 1 dy 67108864))" +
               between(-67108864, "dx", 67108864) + "(assert (= dx (+ (* step dy) rise)))(assert (<= 0 rise (- dy 1)))")
    rounds = ("(declare-const high (_ BitVec 32))(declare-const low (_ BitVec 32))(declare-const d (_ BitVec 32))"
              "(assert (bvult high d))"
              "(define-fun carry () Bool (= ((_ extract 31 31) high) #b1))"
              "(define-fun next () (_ BitVec 32) (bvor (bvshl high #x00000001) (bvlshr low #x0000001f)))"
              "(define-fun one () Bool (or carry (bvuge next d)))"
              "(define-fun left () (_ BitVec 32) (ite one (bvsub next d) next))"
              "(define-fun wide ((a (_ BitVec 32))) (_ BitVec 34) ((_ zero_extend 2) a))"
              "(define-fun taken () (_ BitVec 34) (bvadd (bvshl (wide high) (_ bv1 34)) (wide (bvlshr low #x0000001f))))")
    return [case("QF_NRA", product, refuted("(and (< (* s step) 134217728) (> (* s step) (- 134217728)))")),
            case("QF_NRA", declare("s dy rise q r", "Real"), "(assert (<= 0 s (- dy 1)))(assert (<= 0 rise (- dy 1)))"
                 "(assert (<= 0 r))(assert (< r dy))(assert (= (* s rise) (+ (* q dy) r)))", refuted("(<= q s)")),
            case("QF_BV", rounds, refuted("(and (bvult left d) (= taken (bvadd (wide left) (ite one (wide d) (_ bv0 34)))))")),
            # n >> 32 < dy, or ew_udiv64_32 would not hold the quotient
            case("QF_NRA", declare("s dy rise", "Real"), "(assert (<= 0 s (- dy 1)))(assert (<= 0 rise (- dy 1)))"
                 "(assert (<= 1 dy 67108864))", refuted("(< (* s rise) (* 4294967296 dy))"))]


def narrow_basis():
    """weights_init finds what is_narrow checked: with k = 31 - up bits in reach, the largest |d|."""
    cases = []
    for k in range(1, 21):
        up, top, low = 31 - k, 2 ** k, 2 ** (k - 1)
        basis = (declare("dx1 dy1 dx2 dy2 reach area", "Real") + between(f"(- reach)", "dx1 dy1 dx2 dy2", "reach") +
                 f"(assert (<= {low} reach {top - 1}))" + "(assert (= area (- (* dx1 dy2) (* dx2 dy1))))")
        # 2^(63 - zeros) <= |area| < 2^(64 - zeros): zeros >= up + 12 and zeros <= up + 24
        cases.append(case("QF_NRA", basis, refuted(f"(and (< area {2 ** (52 - up)}) (> area (- {2 ** (52 - up)})))")))
        cases.append(case("QF_NIA", declare("reach magnitude"), f"(assert (<= {low} reach {top - 1}))",
                          "(assert (>= magnitude (* reach (+ (div reach 8) 512))))",
                          refuted(f"(>= magnitude {2 ** (39 - up)})")))
        assert 11 <= up <= 30
    # reach is 1 at least, or all corners were one and place() had found no area
    snapped = "(define-fun snapped ((a Int)) Int (div (+ a 8) 16))"
    cases.append(case("QF_NIA", snapped, declare("x y"),
                      refuted("(= 0 (- (* (- (snapped x) (snapped x)) (- (snapped y) (snapped y)))"
                              " (* (- (snapped x) (snapped x)) (- (snapped y) (snapped y)))))")))
    # from the first corner to the centre of the box's first column (rows alike), which the scissor cuts
    box = (snapped + ROW_AT + LEAST + MOST + declare("x0 x1 x2 clip clip_end from to") +
           "(define-fun s0 () Int (snapped x0))(define-fun s1 () Int (snapped x1))(define-fun s2 () Int (snapped x2))"
           "(assert (< (- 1048576) (- x1 x0) 1048576))(assert (< (- 1048576) (- x2 x0) 1048576))"
           "(assert (= from (most (row_at (least s0 (least s1 s2))) clip)))"
           "(assert (= to (least (row_at (most s0 (most s1 s2))) clip_end)))(assert (< from to))")
    cases.append(case("QF_LIA", box, refuted("(< (- 2097152) (- (+ (* 4096 from) 2048) x0) 2097152)")))
    return cases


def remainder_of_period():
    """within_period, for each period that is no power of 2: the quotient by floor(2^32 / period) is right or
    one too small. A mirrored period is twice the size, and its inverse half that of the size."""
    wide = 2 ** 32

    def floor(quotient, dividend, divisor):
        return f"(assert (<= (* {quotient} {divisor}) {dividend} (- (* (+ {quotient} 1) {divisor}) 1)))"

    return [case("QF_NIA", declare("a inverse period quotient"), between(0, "a", 2 ** 31 - 1), between(1, "period", 4096),
                 floor("inverse", wide, "period"), floor("quotient", "(* a inverse)", wide),
                 refuted("(<= 0 (- a (* quotient period)) (- (* 2 period) 1))")),
            case("QF_NIA", declare("inverse size"), between(1, "size", 2048), floor("inverse", wide, "size"),
                 "(define-fun half () Int (div inverse 2))",
                 refuted(f"(<= (* half (* 2 size)) {wide} (- (* (+ half 1) (* 2 size)) 1))")),
            # 2^32 - 1 and 2^32 have the same quotient by what does not divide 2^32
            case("QF_NIA", declare("inverse size"), between(1, "size", 2048), floor("inverse", wide - 1, "size"),
                 f"(assert (not (= (* (+ inverse 1) size) {wide})))",
                 refuted(f"(<= (* inverse size) {wide} (- (* (+ inverse 1) size) 1))"))]


def within_bits():
    """uv_bits is what the largest difference needs, 32 - its leading zeros, or more; a shade is at most
    256 * 4096, and EW_SHADE_BITS is 21."""
    cases = [case("QF_LIA", declare("s0 s1"), between(0, "s0 s1", 256 * 4096),
                  refuted(f"(< (- {2 ** 21}) (- s1 s0) {2 ** 21})"))]
    for bits in range(0, 28):
        cases.append(case("QF_LIA", MAGNITUDE + MOST + declare("a b c d uv_bits reach"),
                          "(assert (= reach (most (most (magnitude a) (magnitude b)) (most (magnitude c) (magnitude d)))))",
                          f"(assert (< reach {2 ** bits}))",
                          refuted(f"(and (< (- {2 ** bits}) a {2 ** bits}) (< (- {2 ** bits}) b {2 ** bits})"
                                  f" (< (- {2 ** bits}) c {2 ** bits}) (< (- {2 ** bits}) d {2 ** bits}))")))
    return cases


def product_of_pieces():
    """ew_mul_u32_pieces and ew_mul_s32_pieces return the product: `ll` is al bl, `hl` ah bl, and so on."""
    wide, half = 2 ** 32, 2 ** 16
    cases = []
    for below, most, lowest, highest in ((0, half - 1, "0", wide - 1),
                                         (half // 2, half // 2 - 1, f"(- {wide // 2})", wide // 2 - 1)):
        # of the upper halves, of one with a lower half, and of both; `below` is how far below 0 they may be
        least, mixed, both = (f"(- {n})" for n in (below, below * (half - 1), below * most))
        greatest = max(below, most) ** 2
        halves = declare("ah al bh bl", "Real") + between(least, "ah bh", most) + between(0, "al bl", half - 1)
        products = (declare("ll hl lh hh") + between(0, "ll", (half - 1) ** 2) +
                    between(mixed, "hl lh", most * (half - 1)) + between(both, "hh", greatest) +
                    f"(define-fun middle () Int (+ hl (div ll {half})))(define-fun other () Int (+ lh (mod middle {half})))"
                    f"(define-fun high () Int (+ hh (div middle {half}) (div other {half})))"
                    f"(define-fun low () Int (+ (* {half} (mod other {half})) (mod ll {half})))")
        cases += [case("QF_NRA", halves, refuted(f"(= (* (+ (* {half} ah) al) (+ (* {half} bh) bl)) (+ (* {wide} ah bh)"
                                                 f" (* {half} (+ (* ah bl) (* al bh))) (* al bl)))")),
                  case("QF_NRA", halves, refuted(f"(<= 0 (* al bl) {(half - 1) ** 2})")),
                  case("QF_NRA", halves, refuted(f"(<= {mixed} (* ah bl) {most * (half - 1)})")),
                  case("QF_NRA", halves, refuted(f"(<= {both} (* ah bh) {greatest})")),
                  # no sum of 32 bits wraps, and together they are the product
                  case("QF_LIA", products, refuted("(and " + " ".join(
                      f"(<= {lowest} {sum_} {highest})" for sum_ in ("middle", "other", "high")) + ")")),
                  case("QF_LIA", products, refuted(f"(= (+ (* {wide} high) low) (+ (* {wide} hh) (* {half} (+ hl lh)) ll))"))]
    cases.append(case("QF_NRA", declare("a b", "Real") + between(f"(- {wide // 2})", "a b", wide // 2),
                      refuted(f"(<= (- {2 ** 62}) (* a b) {2 ** 62})")))
    return cases


LEMMAS = {f.__name__: f for f in (row_in_edge, between_corners, narrow_basis, within_bits, remainder_of_period,
                                product_of_pieces)}


def ask(text, seconds):
    done = subprocess.run(["z3", "-in", f"-T:{seconds}"], input=text, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)
    return done.stdout.strip()


def prove(name, seconds=60):
    """None, or what is wrong. Hypotheses that contradict each other would prove anything: they have to be
    satisfiable without the goal's negation, which stands last."""
    for number, text in enumerate(LEMMAS[name]()):
        answer = ask(text, seconds)
        if answer != "unsat":
            return f"case {number} of lemma {name}: {answer}"
        answer = ask(text[:text.rindex("(assert (not ")] + "(check-sat)", seconds)
        if answer != "sat":
            return f"case {number} of lemma {name}: its hypotheses are {answer}"
    return None
