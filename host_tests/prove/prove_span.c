/* src/raster/span.c in parts, each with those below it taken at their word: the promises stand here. The target
 * has one row, whose memory, like that of the texture, ends where the last pixel and the last texel do. */
#include "seams.h"

#include "runs.h"

#ifdef EW_PROVE_SHORT
enum { ACROSS = 5 };
#else
enum { ACROSS = 20 };
#endif
enum { ROW = 4095, WIDTHS_LOG2 = 3, HEIGHTS_LOG2 = 2 };

static uint16_t colour[ACROSS], depth[ACROSS], texels[1 << (WIDTHS_LOG2 + HEIGHTS_LOG2)];

/* What a piece still has of pixels lies between the pen and the end of the row. */
#define HAS(k) ((k) <= ACROSS && span->left == (k) && span->fill.textured.pen.colour == colour + (ACROSS - (k)) && \
                span->fill.textured.pen.depth == depth + (ACROSS - (k)))
#define HAS_0_TO_9 (HAS(0) || HAS(1) || HAS(2) || HAS(3) || HAS(4) || HAS(5) || HAS(6) || HAS(7) || HAS(8) || HAS(9))
#define HAS_10_TO_20 (HAS(10) || HAS(11) || HAS(12) || HAS(13) || HAS(14) || HAS(15) || HAS(16) || HAS(17) || \
                      HAS(18) || HAS(19) || HAS(20))
#define IS_GOOD(limit) (0 <= (limit).longest <= 256 && 0 <= (limit).down <= 31 && (limit).scale <= 65535 && \
                        (limit).fall <= 512)

#define IS_WORK(span) (0 <= (span).linear.align <= 63 && (span).is_ready <= 1 && IS_GOOD((span).limit) && \
                       0 <= (span).first <= 256)

/*@ requires run_in_range: 0 <= m <= 256;
    requires left_in_range: 1 <= span->left <= ACROSS;
    requires limit_ready: IS_GOOD(span->limit);
    requires at_pen: span->fill.textured.pen.colour == colour + (ACROSS - span->left);
    requires at_pen_depth: span->fill.textured.pen.depth == depth + (ACROSS - span->left);
    assigns span->linear.w, span->linear.u, span->linear.v, span->fill.textured.pen.w, colour[..], depth[..] \from m;
    assigns span->left \from span->left;
    assigns span->fill.textured.pen.colour \from span->fill.textured.pen.colour;
    assigns span->fill.textured.pen.depth \from span->fill.textured.pen.depth;
    assigns \result \from m;
    ensures next_run: 0 <= \result <= 256;
    ensures pen_moved: HAS_0_TO_9 || HAS_10_TO_20; */
static int32_t runs_of_texture(ew_packing *k, const ew_triangle *t, ew_span_work *span, int32_t m);

/*@ requires left_in_range: 1 <= span->left <= ACROSS;
    requires limit_ready: IS_GOOD(span->limit);
    requires at_pen: span->fill.textured.pen.colour == colour + (ACROSS - span->left);
    requires at_pen_depth: span->fill.textured.pen.depth == depth + (ACROSS - span->left);
    assigns span->linear.w, span->linear.u, span->linear.v, span->fill.textured.pen.w, colour[..], depth[..] \from t->rung;
    assigns span->left \from span->left;
    assigns span->fill.textured.pen.colour \from span->fill.textured.pen.colour;
    assigns span->fill.textured.pen.depth \from span->fill.textured.pen.depth;
    assigns \result \from t->rung;
    ensures next_run: 0 <= \result <= 256;
    ensures pen_moved: HAS_0_TO_9 || HAS_10_TO_20; */
static int32_t pixels_of_texture(ew_packing *k, const ew_triangle *t, ew_span_work *span);

/*@ requires piece_in_range: 1 <= n <= 256;
    requires work_ready: IS_WORK(raster->work.now.span);
    requires at_pen: \valid(raster->work.now.span.fill.textured.pen.colour + (0 .. n - 1));
    requires at_pen_depth: \valid(raster->work.now.span.fill.textured.pen.depth + (0 .. n - 1));
    assigns raster->work.now.span.linear, raster->work.now.span.by, raster->work.now.span.left, colour[..], depth[..] \from n;
    assigns raster->work.now.span.fill.textured.pen.w \from n;
    assigns raster->work.now.span.fill.textured.pen.colour \from raster->work.now.span.fill.textured.pen.colour;
    assigns raster->work.now.span.fill.textured.pen.depth \from raster->work.now.span.fill.textured.pen.depth;
    assigns raster->work.now.span.limit, raster->work.now.span.first, raster->work.now.span.is_ready \from n;
    ensures drawn: raster->work.now.span.fill.textured.pen.colour == \old(raster->work.now.span.fill.textured.pen.colour) + n;
    ensures drawn_depth: raster->work.now.span.fill.textured.pen.depth == \old(raster->work.now.span.fill.textured.pen.depth) + n;
    ensures work_left: IS_WORK(raster->work.now.span); */
static void piece_of_texture(ew_raster *raster, const ew_triangle *t, int32_t n);

/*@ requires piece_in_range: 1 <= n <= 256;
    requires work_ready: IS_WORK(raster->work.now.span);
    requires in_row: raster->work.now.span.fill.any.position.x + n <= ACROSS;
    requires on_row: raster->work.now.span.fill.any.position.y == 4095;
    requires one_of_all: raster->work.now.span.fill.any.position.loop < LOOP_COUNT;
    assigns raster->work.now.span \from n;
    ensures work_left: IS_WORK(raster->work.now.span); */
static void piece_of_any(ew_raster *raster, int32_t n);

#include "src/raster/span.c" /* of the tree that is analysed: planted faults, too */

static ew_raster raster;

/* Loops of their own, and the generic path: other parts prove them. */
void ew_loop_start(ew_raster *r, uint32_t y)
{
    //@ assert loop_row: y == 4095;
    any_bytes(&r->work.now.span.fill.any.loop, sizeof r->work.now.span.fill.any.loop);
}

static int loops_fill; /* either moves the position by as much */

int ew_loop_fill(ew_raster *r, int32_t n)
{
    ew_position *at = &r->work.now.span.fill.any.position;
    if (!loops_fill) return 0;
    //@ assert loop_in_row: 0 <= n && at->x + n <= ACROSS && at->y == 4095;
    at->x = (uint16_t)(at->x + n), at->w = any32();
    return 1;
}

void ew_fill_any(ew_raster *r, ew_run *run, int32_t n)
{
    (void)r;
    //@ assert run_in_row: 0 <= n && run->x + n <= ACROSS && run->y == 4095;
    any_bytes(run, sizeof *run);
}

static void context(void)
{
    const ew_target target = { colour, depth, ACROSS, 1, ACROSS, EW_TARGET_RGB565, any_of(2), ROW };
    any_context(&raster);
    any_bytes(colour, sizeof colour), any_bytes(depth, sizeof depth), any_bytes(texels, sizeof texels);
    raster.target = target;
    raster.scissor.x0 = 0, raster.scissor.x1 = ACROSS, raster.scissor.y0 = ROW, raster.scissor.y1 = ROW + 1;
    raster.texture.texels = texels;
    raster.log2_width = WIDTHS_LOG2, raster.log2_height = HEIGHTS_LOG2;
    ew_packing_init(&raster.work.packing, &raster);
}

/* Any work, with limits of runs as make_ready leaves them. */
static void any_span_work(void)
{
    ew_span_work *span = &raster.work.now.span;
    any_triangle(&raster);
    any_bytes(span, sizeof *span);
    span->first = between(0, EW_LONGEST_RUN);
    span->limit.longest = between(0, EW_LONGEST_RUN), span->limit.down = between(0, 31);
    span->limit.scale = any16(), span->limit.fall = (uint32_t)any_of(513);
    span->linear.align = between(0, 63), span->is_ready = (uint8_t)any_of(2);
}

static void has(int32_t n)
{
    ew_span_work *span = &raster.work.now.span;
    span->left = n;
    pen_at(&span->fill.textured.pen, &raster, ACROSS - n, ROW);
}

/* Runs, one after the other: those behind the first begin wherever a run may end. */
void prove_span_runs(void)
{
    context();
    any_span_work();
    has(ACROSS);
    (void)runs_of_texture(&raster.work.packing, &raster.work.triangle, &raster.work.now.span, between(0, EW_LONGEST_RUN));
}

/* Pixels with a reciprocal each. */
void prove_span_pixels(void)
{
    context();
    any_span_work();
    //@ loop unroll ACROSS;
    for (int32_t n = 1; n <= ACROSS; n++) {
        has(n);
        (void)pixels_of_texture(&raster.work.packing, &raster.work.triangle, &raster.work.now.span);
    }
}

/* A piece: its first run, and then runs and pixels in any order. */
static void piece(int32_t n, int of_any)
{
    ew_position *at = &raster.work.now.span.fill.any.position;
    if (of_any) {
        at->x = (uint16_t)(ACROSS - n), at->y = ROW;
        at->loop = (uint8_t)any_of(LOOP_COUNT);
        loops_fill = 0;
        piece_of_any(&raster, n);
        at->x = (uint16_t)(ACROSS - n);
        loops_fill = 1;
        piece_of_any(&raster, n);
    } else {
        has(n);
        piece_of_texture(&raster, &raster.work.triangle, n);
    }
}

static void pieces(int of_any)
{
    context();
    //@ loop unroll ACROSS;
    for (int32_t n = 1; n <= ACROSS; n++) {
        any_span_work();
        piece(n, of_any);
    }
}

void prove_span_pieces(void)
{
    pieces(0);
}

void prove_span_any(void)
{
    pieces(1);
}


/* An edge that meets the row at a known pixel and goes on anyhow. */
static void edge_is(ew_edge *edge, int32_t x)
{
    const int32_t most = INT32_C(1) << 26;
    edge->x = x, edge->step = between(-most, most), edge->dy = between(1, most);
    edge->remainder = between(-most, -1), edge->rise = between(0, most - 1);
}

/* Rows and spans, of one piece or more. A triangle that is plain here and there is one of the others there. */
static void row_between(int32_t x, int32_t end, uint8_t plain)
{
    ew_triangle *t = &raster.work.triangle;
    ew_edge *edge = raster.work.edge;
    any_span_work();
    t->plain = plain;
    edge_is(&edge[0], x), edge_is(&edge[1], end);
    switch (any_of(plain == PLAIN_NEVER ? 1 : 3)) {
    case 0: (void)ew_rows_of_any(&raster, ROW, ROW + 1); break;
    case 1: (void)ew_rows_of_texture(&raster, t, edge, ROW, ROW + 1); break;
    default: (void)ew_rows_packed(&raster, t, edge, ROW, ROW + 1); break;
    }
}

/* Of rows behind the first, where limits may be ready. */
static void span_of(int32_t x, int32_t n, uint8_t plain)
{
    any_span_work();
    raster.work.triangle.plain = plain;
    if (plain == PLAIN_NEVER || any_of(2)) span_of_any(&raster, x, ROW, n);
    else span_of_texture(&raster, &raster.work.triangle, x, ROW, n);
}

void prove_span(void)
{
    context();
    any_span_work();
    ew_planes_pack(&raster.work.triangle, &raster.work.packing);
    ew_planes_go(&raster.work.triangle, any16(), any16());
    //@ loop unroll ACROSS;
    for (int32_t n = 1; n <= ACROSS; n++) {
        row_between(ACROSS - n, ACROSS, PLAIN_NEVER), span_of(ACROSS - n, n, PLAIN_NEVER);
        row_between(ACROSS - n, ACROSS, PLAIN_ALWAYS), span_of(ACROSS - n, n, PLAIN_ALWAYS);
    }
    row_between(-7, ACROSS + 7, PLAIN_ALWAYS); /* cut on both sides */
    row_between(ACROSS, 3, PLAIN_ALWAYS);      /* nothing */
}
