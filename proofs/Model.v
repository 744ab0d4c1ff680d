(** What the equations speak of: sums, first order, packings, forces, loads, laws of the radii.

    The statements that are generated from the printed equations are read with the words defined here,
    and [root] of Roots.v in Eq. 15, before anything else is loaded; whoever wants to know what
    "accepted" means has to read these two files, and the statements. Nothing is proved here. *)

From Coq Require Import ZArith Reals.

Open Scope R_scope.

(** ** Sums *)

Fixpoint sum_from (low : Z) (count : nat) (f : Z -> R) : R :=
  match count with
  | O => 0
  | S n => sum_from low n f + f (low + Z.of_nat n)%Z
  end.

(** f(low) + … + f(high); 0 when high < low. *)
Definition Sum (low high : Z) (f : Z -> R) : R :=
  sum_from low (Z.to_nat (high - low + 1)) f.

(** ** First order *)

(** Everything depends on ε, the strength of the disorder. "Near" is in some neighbourhood of 0. *)
Definition near (holds : R -> Prop) : Prop :=
  exists width, 0 < width /\ forall e, Rabs e < width -> holds e.

(** f has the value v and the derivative d at ε = 0. *)
Definition expands (f : R -> R) (v d : R) : Prop := f 0 = v /\ derivable_pt_lim f 0 d.

(** Equal to first order: both sides are differentiable at ε = 0, with one value and one slope. *)
Definition first_order (f g : R -> R) : Prop := exists v d, expands f v d /\ expands g v d.

(** ** Vectors, in Cartesian components *)

Record vector := Vector { x_of : R; y_of : R }.

Definition zero := Vector 0 0.
Definition add (u v : vector) := Vector (x_of u + x_of v) (y_of u + y_of v).
Definition scale (a : R) (v : vector) := Vector (a * x_of v) (a * y_of v).
Definition minus (u v : vector) := add u (scale (-1) v).
Definition dot (u v : vector) := x_of u * x_of v + y_of u * y_of v.
Definition norm (v : vector) := sqrt (dot v v).
Definition matrix (a b c d : R) (v : vector) :=
  Vector (a * x_of v + b * y_of v) (c * x_of v + d * y_of v).

Definition first_order_vector (u v : R -> vector) : Prop :=
  first_order (fun e => x_of (u e)) (fun e => x_of (v e)) /\
  first_order (fun e => y_of (u e)) (fun e => y_of (v e)).

(** ** The ordered packing's geometry *)

(** Discs of radius r; n⁺ = (n_x, n_y) and n⁻ = (−n_x, n_y) are unit vectors. The spacing
    s = 4 r n_x lies between 2r and 2√3 r: 1/2 < n_x < √3/2, hence 1/2 < n_y < √3/2. *)
Record lattice := {
  r : R;
  n_x : R;
  n_y : R;
  r_positive : 0 < r;
  n_x_above_half : 1 / 2 < n_x;
  n_y_above_half : 1 / 2 < n_y;
  unit_vectors : n_x ^ 2 + n_y ^ 2 = 1
}.

Section Lattice.
  Variable G : lattice.

  Definition n_plus := Vector (n_x G) (n_y G).
  Definition n_minus := Vector (- n_x G) (n_y G).
  Definition b_plus := Vector (1 / (2 * n_x G)) (1 / (2 * n_y G)).
  Definition b_minus := Vector (- (1 / (2 * n_x G))) (1 / (2 * n_y G)).
  Definition e_y := Vector 0 1.
  Definition phi := dot n_plus n_minus.
End Lattice.

(** ** Packings *)

(** Bead (i, j) of a packing of height M: i + j even, 0 ≤ j ≤ M. A contact is named by its lower
    bead (i, j), j < M: along n⁺ it leads to (i + 1, j + 1), along n⁻ to (i − 1, j + 1). *)
Definition bead (M i j : Z) : Prop := ((i + j) mod 2 = 0 /\ 0 <= j <= M)%Z.
Definition contact (M i j : Z) : Prop := ((i + j) mod 2 = 0 /\ 0 <= j < M)%Z.

(** The radius of bead (i, j) is r + δr with δr = ε ρ. *)
Definition radii := Z -> Z -> R.

Definition delta_r (rho : radii) (i j : Z) (e : R) : R := e * rho i j.

(** Δ_ij, and the braces of Eq. 12: one value up to a layer, another above it. *)
Definition second_difference (rho : radii) (i j : Z) (e : R) : R :=
  2 * delta_r rho i j e - delta_r rho (i - 2) j e - delta_r rho (i + 2) j e.
Definition braces (below above : R) (m last : Z) : R := if (m <=? last)%Z then below else above.

(** The centre of bead (i, j) at a strength ε. *)
Definition centres := Z -> Z -> R -> vector.

Definition touch (G : lattice) (rho : radii) (X : centres) (i j k l : Z) : Prop :=
  near (fun e =>
    dot (minus (X i j e) (X k l e)) (minus (X i j e) (X k l e)) =
    ((r G + delta_r rho i j e) + (r G + delta_r rho k l e)) ^ 2).

(** Discs of radii r + ε ρ on a fixed base, each in exact contact with its two supports and, in
    the ordered packing, above them; the centres depend continuously on ε at ε = 0. *)
Record packing (G : lattice) (M : Z) (rho : radii) (X : centres) : Prop := {
  base_is_fixed : forall i e, bead M i 0 -> X i 0%Z e = Vector (2 * IZR i * r G * n_x G) 0;
  continuous : forall i j, bead M i j ->
    continuity_pt (fun e => x_of (X i j e)) 0 /\ continuity_pt (fun e => y_of (X i j e)) 0;
  touches_left : forall i j, bead M i j -> (1 <= j)%Z -> touch G rho X i j (i - 1) (j - 1);
  touches_right : forall i j, bead M i j -> (1 <= j)%Z -> touch G rho X i j (i + 1) (j - 1);
  above_supports : forall i j, bead M i j -> (1 <= j)%Z ->
    y_of (X (i - 1)%Z (j - 1)%Z 0) < y_of (X i j 0)
}.

Section Packing.
  Variable G : lattice.
  Variable X : centres.

  (** Position in the ordered packing, ε = 0, and displacement from it. *)
  Definition position (i j : Z) : vector := X i j 0.
  Definition delta_x (i j : Z) (e : R) : vector := minus (X i j e) (X i j 0).

  (** Unit vector from one centre to another; its change from n⁺ or n⁻. *)
  Definition direction (from to : vector) : vector := scale (/ norm (minus to from)) (minus to from).
  Definition N_plus (i j : Z) (e : R) := direction (X i j e) (X (i + 1)%Z (j + 1)%Z e).
  Definition N_minus (i j : Z) (e : R) := direction (X i j e) (X (i - 1)%Z (j + 1)%Z e).
  Definition delta_n_plus (i j : Z) (e : R) := minus (N_plus i j e) (n_plus G).
  Definition delta_n_minus (i j : Z) (e : R) := minus (N_minus i j e) (n_minus G).
End Packing.

(** ** Forces *)

(** f⁺_ij, f⁻_ij: magnitudes of the forces of the contacts of bead (i, j) with the two beads above
    it, positive when compressive. Frictionless: they act along the line of the centres. *)
Record forces := Forces { f_plus : Z -> Z -> R -> R; f_minus : Z -> Z -> R -> R }.

(** The balance of bead (i, j): its load, its supports pushing, the beads above pushing back. *)
Definition balanced (X : centres) (F : forces) (load : vector) (i j : Z) (e : R) : Prop :=
  add load
    (minus
      (add (scale (f_plus F (i - 1) (j - 1) e) (N_plus X (i - 1) (j - 1) e))
           (scale (f_minus F (i + 1) (j - 1) e) (N_minus X (i + 1) (j - 1) e)))
      (add (scale (f_plus F i j e) (N_plus X i j e))
           (scale (f_minus F i j e) (N_minus X i j e)))) = zero.

(** What the two contacts above bead (i, j) press it down with. *)
Definition pressed_down (X : centres) (F : forces) (i j : Z) (e : R) : R :=
  y_of (add (scale (f_plus F i j e) (N_plus X i j e)) (scale (f_minus F i j e) (N_minus X i j e))).

(** Exact balance of every bead above the base; there is no contact above the surface. *)
Record carries (M : Z) (X : centres) (load : Z -> Z -> vector) (F : forces) : Prop := {
  free_surface : forall i e, f_plus F i M e = 0 /\ f_minus F i M e = 0;
  balance : forall i j, bead M i j -> (1 <= j)%Z -> near (balanced X F (load i j) i j)
}.

Definition downwards (load : R) : vector := Vector 0 (- load).

(** The loads of the paper: on bead (k, l) alone, on the whole surface, a weight on every bead. *)
Definition single (k l : Z) (load : R) (i j : Z) : vector :=
  if ((i =? k) && (j =? l))%bool%Z then downwards load else zero.
Definition surface (M : Z) (load : R) (_ j : Z) : vector :=
  if (j =? M)%Z then downwards load else zero.
Definition bulk (weight : R) (_ _ : Z) : vector := downwards weight.

(** ** Random radii *)

(** Beads at most W from i = 0: where the radii's second moments are given. *)
Definition within (W M i j : Z) : Prop := bead M i j /\ (Z.abs i <= W)%Z.

(** A law of the radii, as far as it matters: an expectation that is linear on a class of functions
    of the radii; those of the window have mean 0, are uncorrelated and have the variance σ².
    Independent radii of any distribution with that mean and variance have such an expectation. *)
Record law (W M : Z) (sigma : R) := {
  integrable : (radii -> R) -> Prop;
  expect : (radii -> R) -> R;
  integrable_constant : forall c, integrable (fun _ => c);
  integrable_sum : forall f g, integrable f -> integrable g -> integrable (fun rho => f rho + g rho);
  integrable_multiple : forall c f, integrable f -> integrable (fun rho => c * f rho);
  expect_constant : forall c, expect (fun _ => c) = c;
  expect_sum : forall f g, integrable f -> integrable g ->
    expect (fun rho => f rho + g rho) = expect f + expect g;
  expect_multiple : forall c f, integrable f -> expect (fun rho => c * f rho) = c * expect f;
  radii_integrable : forall i j, within W M i j -> integrable (fun rho => rho i j);
  products_integrable : forall i j k l, within W M i j -> within W M k l ->
    integrable (fun rho => rho i j * rho k l);
  mean_radius : forall i j, within W M i j -> expect (fun rho => rho i j) = 0;
  second_moments : forall i j k l, within W M i j -> within W M k l ->
    expect (fun rho => rho i j * rho k l) = if ((i =? k) && (j =? l))%bool%Z then sigma ^ 2 else 0
}.
Arguments integrable {W M sigma}.
Arguments expect {W M sigma}.

Definition variance {W M sigma} (L : law W M sigma) (f : radii -> R) : R :=
  expect L (fun rho => (f rho - expect L f) ^ 2).

(** f is g to first order in δr, where δr = ρ: value and slope of g, added. *)
Definition linearised (g : radii -> R -> R) (f : radii -> R) : Prop :=
  forall rho, exists v d, expands (g rho) v d /\ f rho = v + d.

(** σ_f²/⟨f⟩², and the root of its mean over one contact of each layer. *)
Definition relative_variance {W M sigma} (L : law W M sigma) (f : radii -> R) : R :=
  variance L f / expect L f ^ 2.
Definition root_mean_square {W M sigma} (L : law W M sigma) (f : Z -> radii -> R) : R :=
  sqrt (Sum 0 (M - 1) (fun j => relative_variance L (f j)) / IZR M).

(** What proportionality may depend on: φ alone. *)
Definition constant (c : R -> R) : Prop := forall x, - (1 / 2) < x < 1 / 2 -> 0 < c x.
