/* The cell of a coordinate along an axis, of which `grid` has the origin, the cells a metre, and for a
   periodic axis how many cells there are. Far away all is one cell. */
LAW int list_cell(const double x, GLOBAL const double *grid)
{
    const double cell = floor((x - grid[0]) * grid[1]);
    const double least = grid[2] > 0 ? 0 : -1073741824.0;
    const double most = grid[2] > 0 ? grid[2] - 1 : 1073741824.0;
    return cell > least ? (cell < most ? (int)cell : (int)most) : (int)least;
}

/* What a cell of an axis gives to the place in the table: its last bits, between those of other axes. */
LAW unsigned list_spread(const int cell, const int axis, GLOBAL const double *grid)
{
    const int bits = (int)grid[4 * axis + 3];
    unsigned place = 0;
    for (int bit = 0; bit < bits; ++bit) {
        int to = 0;
        for (int other = 0; other < D; ++other) {
            const int has = (int)grid[4 * other + 3];
            to += (has < bit ? has : bit) + (other < axis && has > bit ? 1 : 0);
        }
        place |= (((unsigned)cell >> bit) & 1u) << to;
    }
    return place;
}

/* Least and largest coordinates of some particles of every `threads`. */
KERNEL void list_bounds(const int n, const int threads, GLOBAL const double *low, GLOBAL const double *high, GLOBAL double *lower, GLOBAL double *upper)
{
    EACH(t, threads) {
        for (int axis = 0; axis < D; ++axis) {
            double least = P_INFINITY, most = -P_INFINITY;
            for (int a = t; a < n; a += threads) {
                const double x = low[a * D + axis], y = high[a * D + axis];
                least = x < least ? x : least;
                most = y > most ? y : most;
            }
            lower[t * D + axis] = least;
            upper[t * D + axis] = most;
        }
    }
}

/* The cell of each particle by number, and how many each cell has. */
KERNEL void list_cells(const int n, GLOBAL const double *grid, GLOBAL const double *position, GLOBAL unsigned *cell, GLOBAL unsigned *count)
{
    EACH(a, n) {
        unsigned place = 0;
        for (int axis = 0; axis < D; ++axis) {
            place |= list_spread(list_cell(position[a * D + axis], grid + 4 * axis), axis, grid);
        }
        cell[a] = place;
        ADD(count + place, 1u);
    }
}

/* Puts numbers into their cells, in any order, and takes the counts back to zero. */
KERNEL void list_put(const int n, GLOBAL const unsigned *cell, GLOBAL const unsigned *start, GLOBAL unsigned *count, GLOBAL unsigned *member)
{
    EACH(a, n) {
        const unsigned place = cell[a];
        member[start[place] + ADD(count + place, 0xffffffffu) - 1u] = (unsigned)a;
    }
}

/* Slots: cell by cell, within one by key, which is the number with the bits of what a particle is: the highest one if it
   is passive, the next one, too, if it is excluded. */
KERNEL void list_order(const int n, GLOBAL const unsigned *RESTRICT passive, GLOBAL const unsigned *RESTRICT cell, GLOBAL const unsigned *RESTRICT start, GLOBAL const unsigned *RESTRICT member, GLOBAL const double *RESTRICT position, GLOBAL unsigned *RESTRICT number, GLOBAL unsigned *RESTRICT slot, GLOBAL unsigned *RESTRICT key, GLOBAL double *RESTRICT made_at)
{
    EACH(k, n) {
        const unsigned a = member[k], mine = a | passive[a], end = start[cell[a] + 1];
        unsigned s = start[cell[a]];
        for (unsigned other = s; other < end; ++other) {
            s += (member[other] | passive[member[other]]) < mine ? 1u : 0u;
        }
        number[s] = a;
        slot[a] = s;
        key[s] = mine;
        for (int axis = 0; axis < D; ++axis) made_at[s * D + axis] = position[a * D + axis];
    }
}

/* Sums of 32 each, which end at the largest number. */
KERNEL void list_sums(const int n, const int threads, GLOBAL const unsigned *count, GLOBAL unsigned *sum)
{
    EACH(t, threads) {
        unsigned total = 0;
        for (int k = 32 * t; k < 32 * t + 32 && k < n; ++k) {
            total = total + count[k] < total ? 0xffffffffu : total + count[k];
        }
        sum[t] = total;
    }
}

/* Sums of all before each of 32, from a base on. */
KERNEL void list_before(const int n, const int threads, GLOBAL const unsigned *base, GLOBAL const unsigned *count, GLOBAL unsigned *before)
{
    EACH(t, threads) {
        unsigned total = base[t];
        for (int k = 32 * t; k < 32 * t + 32 && k < n; ++k) {
            const unsigned more = count[k];
            before[k] = total;
            total += more;
        }
    }
}

/* Counts the candidates of each slot, and those of them that are not passive; then writes their keys. What is excluded
   has none, and is none. */
KERNEL void list_candidates(const int n, const int writes, const double reach, GLOBAL const double *RESTRICT period, GLOBAL const double *RESTRICT grid, GLOBAL const unsigned *RESTRICT start, GLOBAL const double *RESTRICT made_at, GLOBAL const unsigned *RESTRICT key, GLOBAL unsigned *RESTRICT count, GLOBAL unsigned *RESTRICT active, GLOBAL const unsigned *RESTRICT first, GLOBAL unsigned *RESTRICT passive_first, GLOBAL unsigned *RESTRICT found)
{
    EACH(s, n) {
        const unsigned mine = key[s];
        double here[D], periods[D];
        /* Places of the cells around it along each axis, each once. */
        unsigned around[3][3];
        int differing[3] = {1, 1, 1};
        for (int axis = 0; axis < 3; ++axis) around[axis][0] = 0;
        for (int axis = 0; axis < D; ++axis) {
            here[axis] = made_at[s * D + axis];
            periods[axis] = period[axis];
            const int cell = list_cell(here[axis], grid + 4 * axis), cells = (int)grid[4 * axis + 2];
            differing[axis] = 0;
            for (int step = -1; step <= 1; ++step) {
                int next = cell + step;
                if (cells > 0) next = next < 0 ? cells - 1 : (next == cells ? 0 : next);
                const unsigned place = list_spread(next, axis, grid);
                int is_new = 1;
                for (int k = 0; k < differing[axis]; ++k) is_new &= around[axis][k] != place;
                if (is_new) around[axis][differing[axis]++] = place;
            }
        }
        unsigned all = 0, others = 0, to = writes ? first[s] : 0;
        for (int i = 0; i < differing[0]; ++i) for (int j = 0; j < differing[1]; ++j) for (int k = 0; k < differing[2]; ++k) {
            const unsigned place = around[0][i] | around[1][j] | around[2][k];
            const unsigned end = start[place + 1];
            for (unsigned b = start[place]; b < end; ++b) {
                const unsigned its = key[b];
                const int are_in = ((its | mine) & 0x40000000u) == 0;
                double there[D];
                for (int axis = 0; axis < D; ++axis) there[axis] = made_at[b * D + axis];
                if (its != mine && ((its & mine) >> 31) == 0 && are_in && list_square(here, periods, there) < reach * reach) {
                    if (writes) found[to + all] = its;
                    all += 1;
                    others += 1u - (its >> 31);
                }
            }
        }
        if (writes) {
            passive_first[s] = to + others;
        } else {
            count[s] = all;
            active[s] = others;
        }
    }
}

/* Rows of candidates in the order of their keys. */
KERNEL void list_sort(const int n, GLOBAL const unsigned *RESTRICT first, GLOBAL const unsigned *RESTRICT found, GLOBAL const unsigned *RESTRICT slot, GLOBAL unsigned *RESTRICT candidate)
{
    EACH(thread, n * LANES) {
        const int s = thread / LANES, lane = thread % LANES;
        const int from = (int)first[s], to = (int)first[s + 1];
        for (int e = from + lane; e < to; e += 5 * LANES) {
            unsigned mine[5], rank[5];
            for (int k = 0; k < 5; ++k) {
                mine[k] = e + k * LANES < to ? found[e + k * LANES] : 0;
                rank[k] = 0;
            }
            for (int other = from; other < to; ++other) {
                const unsigned its = found[other];
                for (int k = 0; k < 5; ++k) rank[k] += its < mine[k] ? 1u : 0u;
            }
            for (int k = 0; k < 5; ++k) {
                if (e + k * LANES < to) candidate[from + rank[k]] = slot[mine[k] & 0x7fffffffu];
            }
        }
    }
}

/* The candidates inside the support, in their order. */
KERNEL void list_pick(const int n, const double support, GLOBAL const double *RESTRICT period, GLOBAL const double *RESTRICT position, GLOBAL const unsigned *RESTRICT first, GLOBAL const unsigned *RESTRICT passive_first, GLOBAL const unsigned *RESTRICT candidate, GLOBAL unsigned *RESTRICT active, GLOBAL unsigned *RESTRICT passive_count, GLOBAL unsigned *RESTRICT entry)
{
    EACH(thread, n * LANES) {
        const int s = thread / LANES, lane = thread % LANES;
        double here[D], there[D], periods[D];
        list_place(position, n, (unsigned)s, here);
        for (int axis = 0; axis < D; ++axis) periods[axis] = period[axis];
        for (int kind = 0; kind < 2; ++kind) {
            const int from = (int)(kind ? passive_first[s] : first[s]);
            const int to = (int)(kind ? first[s + 1] : passive_first[s]);
            int count = 0;
            for (int k = from; k < to; k += LANES) {
                const unsigned b = candidate[k + lane < to ? k + lane : from];
                list_place(position, n, b, there);
                const int is_inside = k + lane < to && list_square(here, periods, there) < support * support;
                const unsigned votes = VOTES(is_inside);
                if (is_inside) entry[from + count + (int)COUNT(votes & ((1u << lane) - 1u))] = b;
                count += (int)COUNT(votes);
            }
            if (lane == 0) (kind ? passive_count : active)[s] = (unsigned)count;
        }
    }
}
