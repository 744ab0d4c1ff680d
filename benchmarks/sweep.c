/* The sweep for discs, written out by hand in C: one whole periodic packing in float64.
   Blocks are (top + 1) rows of `width`; row 0 of the δn and of the forces is not touched.
   Built by speed.py only, to be compared with: as many operations, in another order. */
#include <math.h>
#include <stddef.h>

typedef const double *restrict in;
typedef double *restrict out;

static void place(ptrdiff_t n, in ap, in am, in bp, in bm, in own, in ra, in rb, out cp, out cm,
                  out pa, out pb, out ma, out mb, double phi, double inverse)
{
    for (ptrdiff_t q = 0; q < n; q++) {
        double rho_p = own[q] + ra[q], rho_m = own[q] + rb[q];
        double up = ap[q] - bp[q], um = am[q] - bm[q];
        double Up = (up - phi * um) * inverse, Um = (um - phi * up) * inverse;
        double rp = rho_p + rho_p * rho_p / 4, rm = rho_m + rho_m * rho_m / 4;
        double guess = rm - um, tilt_p = 1 - Up / 2, tilt_m = 1 + Um / 2;
        double gap = ((rp + up / 2) * Up + (guess + um / 2) * Um) / 2;
        double lift = gap / tilt_m, pm0 = guess - lift, e = tilt_p / tilt_m;
        double Ep = (1 - phi * e) * inverse, Em = (e - phi) * inverse;
        double Pp = (rp - phi * pm0) * inverse, Pm = (pm0 - phi * rp) * inverse;
        double size = rp * Pp + pm0 * Pm, b = 1 + (rp * Ep + pm0 * Em) / 2;
        double discriminant = b * b - (Ep + e * Em) * size / 4;
        double A = size / (b + sqrt(discriminant)) / 2, B = A * e + lift;
        cp[q] = ap[q] + (rp - A);
        cm[q] = bm[q] + (rm - B);
        double length = 2 + rho_p;
        double along = (rho_p * rho_p / 4 - A) / length;
        double across = (pm0 - A * e - phi * rho_p) / length;
        pa[q] = (along - phi * across) * inverse;
        pb[q] = (across - phi * along) * inverse;
        length = 2 + rho_m;
        along = (rho_m * rho_m / 4 - B) / length;
        across = (rp - A + up - phi * rho_m) / length;
        mb[q] = (along - phi * across) * inverse;
        ma[q] = (across - phi * along) * inverse;
    }
}

static void balance(ptrdiff_t n, in Fp, in Fm, in Fr, in gr, in ra, in rb, in er, in Fl, in gl,
                    in la, in lb, in el, in pa, in pb, in ma, in mb, out gp, out gm, out ep,
                    out em)
{
    for (ptrdiff_t q = 0; q < n; q++) {
        double fp = Fr[q] + gr[q], fm = Fl[q] + gl[q];
        double tp = fp * ra[q] + fm * la[q] + er[q] - Fp[q] * pa[q] - Fm[q] * ma[q];
        double tm = fp * rb[q] + fm * lb[q] + el[q] - Fp[q] * pb[q] - Fm[q] * mb[q];
        double minor = pa[q] * mb[q] - ma[q] * pb[q];
        double det = 1 + (pa[q] + mb[q] + minor);
        double sp = gr[q] + tp, sm = gl[q] + tm;
        tp -= (sp * (pa[q] + minor) + sm * ma[q]) / det;
        tm -= (sm * (mb[q] + minor) + sp * pb[q]) / det;
        double hp = gr[q] + tp, hm = gl[q] + tm, kp = hp - gr[q], km = hm - gl[q];
        ep[q] = (gr[q] - (hp - kp)) + (tp - kp);
        em[q] = (gl[q] - (hm - km)) + (tm - km);
        gp[q] = hp;
        gm[q] = hm;
    }
}

/* Deposit, then carry a surface load (components load_p, load_m on every bead of the top). */
void sweep(ptrdiff_t top, ptrdiff_t width, double phi, double inverse, double load_p,
           double load_m, const double *nothing, double *lost, const double *rho, double *cp, double *cm,
           double *pa, double *pb, double *ma, double *mb, double *Fp, double *Fm, double *gp,
           double *gm)
{
    for (ptrdiff_t q = 0; q < width; q++)
        cp[q] = cm[q] = 0;
    for (ptrdiff_t j = 1; j <= top; j++) {
        for (int edge = 0; edge < 2; edge++) {
            ptrdiff_t own = j * width + (edge ? (width - 1) * (j % 2) : 1 - j % 2);
            ptrdiff_t left = (j - 1) * width + (edge ? width - 1 : 0);
            ptrdiff_t right = (j - 1) * width + (edge ? 0 : 1);
            place(edge ? 1 : width - 1, cp + left, cm + left, cp + right, cm + right, rho + own,
                  rho + left, rho + right, cp + own, cm + own, pa + own, pb + own, ma + own,
                  mb + own, phi, inverse);
        }
    }
    for (ptrdiff_t q = width; q < (top + 1) * width; q++) {
        Fp[q] = load_p;
        Fm[q] = load_m;
    }
    for (ptrdiff_t j = top; j >= 1; j--) {
        for (int edge = 0; edge < 2; edge++) {
            ptrdiff_t own = j * width + (edge ? (width - 1) * (j % 2) : 1 - j % 2);
            ptrdiff_t l = (edge ? width - 1 : 0), r = (edge ? 0 : 1), up = (j + 1) * width;
            const double *z = nothing;
            double *mine = lost + j % 2 * 2 * width + own - j * width;
            const double *old = lost + (j + 1) % 2 * 2 * width;
            int last = j == top;
            balance(edge ? 1 : width - 1, Fp + own, Fm + own, last ? z : Fp + up + r,
                    last ? z : gp + up + r, last ? z : pa + up + r, last ? z : pb + up + r,
                    last ? z : old + r, last ? z : Fm + up + l, last ? z : gm + up + l,
                    last ? z : ma + up + l, last ? z : mb + up + l, last ? z : old + width + l,
                    pa + own, pb + own, ma + own, mb + own, gp + own, gm + own, mine,
                    mine + width);
        }
    }
}

/* a = b + c, to see how fast memory is. */
void triad(ptrdiff_t n, double *restrict a, const double *restrict b, const double *restrict c)
{
    for (ptrdiff_t q = 0; q < n; q++)
        a[q] = b[q] + c[q];
}
