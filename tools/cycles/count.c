/* A QEMU plugin that counts executed instructions between two places of a firmware.
 *
 *   -plugin count.so,begin=0xADDR,end=0xADDR,out=FILE[,edges=1]
 *
 * A region runs from the translated block that starts at BEGIN up to the one that starts
 * at END; each writes a line "R instructions" to FILE. With edges=1 it is followed by what a
 * cycle model needs, hexadecimal addresses of first and last instructions:
 *
 *   B first last executed            for each block
 *   E first last next-first times    for each way from one block to the next
 *
 * Conditional instructions that are skipped inside an IT block count as executed, as they
 * take their slot.
 *
 * Debian 12 ships no qemu-plugin.h; the declarations below are the part of QEMU's plugin
 * interface, version 1 (QEMU 4.2 to 8), that is used here.
 */
#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef uint64_t qemu_plugin_id_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
typedef struct qemu_info_t qemu_info_t;
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *tb);
struct qemu_plugin_insn *qemu_plugin_tb_get_insn(const struct qemu_plugin_tb *tb, size_t i);
uint64_t qemu_plugin_insn_vaddr(const struct qemu_plugin_insn *insn);
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id,
                                           void (*cb)(qemu_plugin_id_t id, struct qemu_plugin_tb *tb));
void qemu_plugin_register_vcpu_tb_exec_cb(struct qemu_plugin_tb *tb, void (*cb)(unsigned vcpu, void *user), int flags,
                                          void *user);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*cb)(qemu_plugin_id_t id, void *user), void *user);

#define EXPORT __attribute__((visibility("default")))
EXPORT int qemu_plugin_version = 1;
EXPORT int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t *info, int argc, char **argv);

struct block;
struct edge {
    struct block *to;
    uint64_t times;
    struct edge *next;
};
struct block {
    uint64_t first, last, instructions, executed;
    struct edge *edges; /* the latest first */
    struct block *next;
};

static uint64_t begin, end, count;
static bool counting, with_edges;
static FILE *out;
static struct block *blocks, *before;

static void *zeroed(size_t bytes)
{
    void *p = calloc(1, bytes); /* lives as long as QEMU keeps the block: to the end */
    if (!p) abort();
    return p;
}

static void count_edge(struct block *from, struct block *to)
{
    struct edge **at = &from->edges;
    while (*at && (*at)->to != to) at = &(*at)->next;
    struct edge *e = *at;
    if (e) {
        *at = e->next;
    } else {
        e = zeroed(sizeof *e);
        e->to = to;
    }
    e->next = from->edges;
    from->edges = e;
    e->times++;
}

static void write_region(void)
{
    fprintf(out, "R %" PRIu64 "\n", count);
    for (struct block *b = blocks; b; b = b->next) {
        if (!b->executed) continue;
        if (with_edges) fprintf(out, "B %" PRIx64 " %" PRIx64 " %" PRIu64 "\n", b->first, b->last, b->executed);
        b->executed = 0;
        for (struct edge *e = b->edges; e; e = e->next) {
            if (e->times) {
                fprintf(out, "E %" PRIx64 " %" PRIx64 " %" PRIx64 " %" PRIu64 "\n", b->first, b->last, e->to->first,
                        e->times);
            }
            e->times = 0;
        }
    }
}

static void executed(unsigned vcpu, void *user)
{
    struct block *b = user;
    (void)vcpu;
    if (b->first == begin) counting = true, count = 0, before = NULL;
    if (b->first == end && counting) {
        counting = false;
        write_region();
    }
    if (!counting) return;
    count += b->instructions;
    b->executed++;
    if (with_edges && before) count_edge(before, b);
    before = b;
}

static void translated(qemu_plugin_id_t id, struct qemu_plugin_tb *tb)
{
    (void)id;
    uint64_t n = qemu_plugin_tb_n_insns(tb);
    uint64_t first = qemu_plugin_insn_vaddr(qemu_plugin_tb_get_insn(tb, 0));
    uint64_t last = qemu_plugin_insn_vaddr(qemu_plugin_tb_get_insn(tb, n - 1));
    struct block *b = blocks;
    while (b && !(b->first == first && b->last == last && b->instructions == n)) b = b->next;
    if (!b) {
        b = zeroed(sizeof *b);
        b->first = first;
        b->last = last;
        b->instructions = n;
        b->next = blocks;
        blocks = b;
    }
    qemu_plugin_register_vcpu_tb_exec_cb(tb, executed, 0, b);
}

static void at_exit(qemu_plugin_id_t id, void *user)
{
    (void)id;
    (void)user;
    fclose(out);
}

int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t *info, int argc, char **argv)
{
    (void)info;
    for (int i = 0; i < argc; i++) {
        if (strncmp(argv[i], "begin=", 6) == 0) begin = strtoull(argv[i] + 6, NULL, 0);
        else if (strncmp(argv[i], "end=", 4) == 0) end = strtoull(argv[i] + 4, NULL, 0);
        else if (strncmp(argv[i], "out=", 4) == 0) out = fopen(argv[i] + 4, "w");
        else if (strncmp(argv[i], "edges=", 6) == 0) with_edges = argv[i][6] == '1';
        else return -1;
    }
    if (!out || !begin || !end) return -1;
    qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
    qemu_plugin_register_atexit_cb(id, at_exit, NULL);
    return 0;
}
