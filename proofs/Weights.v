(** The forces under surface and bulk loads as weights of single radii, layer by layer. What Eq. 12 leaves out of
    them is small. *)

From Coq Require Import ZArith Reals Lia Lra List.
From ForceDiffusion Require Import Model Sums FirstOrder Lattice Geometry Mirror Forces Random.
Import ListNotations.

Open Scope R_scope.
Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.

Definition on (b : bool) (x : R) : R := if b then x else 0.

(** Decide every [on]; what contradicts the hypotheses goes. *)
Ltac decide_on :=
  unfold on;
  repeat match goal with
  | |- context [if ?b then _ else _] =>
      let E := fresh "E" in destruct b eqn:E; try (exfalso; lia)
  end.

Lemma Sum_up_to low mid high f : (low <= mid + 1)%Z -> (mid <= high)%Z ->
  Sum low high (fun m => on (m <=? mid)%Z (f m)) = Sum low mid f.
Proof.
  intros H1 H2. rewrite (Sum_split low mid high) by lia.
  rewrite (Sum_zero (mid + 1) high), Rplus_0_r by (intros; unfold on; replace (m <=? mid)%Z with false by lia; auto).
  apply Sum_eq; auto. intros m Hm. unfold on. replace (m <=? mid)%Z with true by lia. reflexivity.
Qed.

Lemma Sum_at low high a f : (low <= a <= high)%Z ->
  Sum low high (fun m => on (m =? a)%Z (f m)) = f a.
Proof.
  intros H. rewrite <- (Sum_pick low high a (f a)) by lia. apply Sum_eq; auto.
  intros m Hm. unfold on. destruct (Z.eqb_spec m a) as [->|]; [rewrite Z.eqb_refl; reflexivity|].
  replace (a =? m)%Z with false by lia. reflexivity.
Qed.

(** ** One form under both loads *)

(** Weights on the places i − j + m − 2, i − j + m, i − j + m + 2 of the diagonal along n⁺ and, below
    the contact, i + j − m and i + j − m + 2 of the one along n⁻. *)
Record weights := { w_a : Z -> R; w_b : Z -> R; w_c : Z -> R; w_p : Z -> R; w_q : Z -> R }.

Definition layers (i j : Z) (w : weights) (m : Z) : layer :=
  [(w_a w m, i - j + m - 2); (w_b w m, i - j + m); (w_c w m, i - j + m + 2);
   (w_p w m, i + j - m); (w_q w m, i + j - m + 2)]%Z.

Lemma layers_inside W M i j w : contact M i j -> (Z.abs i + M + 2 <= W)%Z ->
  forall m, (0 <= m <= M)%Z -> inside W M (layers i j w m) m.
Proof.
  intros H HW m Hm. unfold inside, layers, within, contact, bead in *.
  repeat (apply Forall_cons; [cbn [snd]; lia|]). apply Forall_nil.
Qed.

Section Surface.
  Context (G : lattice) (rho : radii) (i j : Z) (base : (0 <= j)%Z).
  Local Notation phi := (phi G).
  Local Notation r := (r G).

  (** A height more adds the difference of two tilts: the sum over branches, by parts. *)
  Lemma change_plus_higher M : (j < M)%Z ->
    change_plus G rho (M + 1) i j = change_plus G rho M i j
      - (tilt_minus G rho (i - j + M + 2) M - tilt_minus G rho (i - j + M) M) / (1 - phi * phi).
  Proof.
    intros H. pose proof (divisor_positive G). unfold change_plus, turned.
    replace (M + 1 - j - 1)%Z with (M - j)%Z by lia.
    rewrite (Sum_last 1 (M - j)), Z.add_simpl_r by lia.
    normal_form. field. lra.
  Qed.

  Definition twice (m : Z) : R := if (m =? 0)%Z then 1 else 2.

  (** The weights of 2r (1 − φ²) times the relative change under a surface load at height l. *)
  Definition surface_weights (l : Z) : weights := {|
    w_a m := on (m <=? l)%Z (twice m * IZR (l - Z.max m (j + 1)))
      + on ((j + 2 <=? m) && (m <=? l))%bool%Z (1 - phi);
    w_b m := on (m <=? l)%Z (-2 * (twice m * IZR (l - Z.max m (j + 1)))) - on (m <=? j)%Z (twice m)
      + on ((j + 1 <=? m) && (m <=? l - 1))%bool%Z (1 - phi)
      - on ((j + 2 <=? m) && (m <=? l))%bool%Z (1 - phi)
      + on (m =? j)%Z (phi * (1 - phi)) - on (m =? j + 1)%Z ((1 - phi) * (1 - phi));
    w_c m := on (m <=? l)%Z (twice m * IZR (l - Z.max m (j + 1))) + on (m <=? j)%Z (twice m)
      - on ((j + 1 <=? m) && (m <=? l - 1))%bool%Z (1 - phi) - on (m =? j)%Z (1 - phi);
    w_p m := on (m <=? j)%Z (- phi * twice m);
    w_q m := on (m <=? j)%Z (phi * twice m) |}.

  Lemma Sum_twice n f : (0 <= n)%Z ->
    Sum 0 n (fun m => twice m * f m) = f 0%Z + 2 * Sum 1 n f.
  Proof.
    intros H. rewrite Sum_first by lia. unfold twice at 1. cbn [Z.eqb].
    rewrite <- Sum_scale. replace (0 + 1)%Z with 1%Z by lia. rewrite Rmult_1_l. f_equal.
    apply Sum_eq; auto. intros m Hm. unfold twice. replace (m =? 0)%Z with false by lia. reflexivity.
  Qed.

  Theorem surface_in_layers M l : (j < l)%Z -> (l <= M)%Z ->
    2 * r * (1 - phi * phi) * change_plus G rho l i j =
    Sum 0 M (fun m => weigh (layers i j (surface_weights l) m) m rho).
  Proof.
    pose proof (divisor_positive G) as Hd. pose proof (r_pos G) as Hr.
    intros H. pattern l. apply (up_from _ (j + 1)); [| |lia]; clear l H.
    - intros HM. unfold change_plus. rewrite turned_at_top.
      rewrite (Sum_eq 0 M 0 M _ (fun m =>
        on (m <=? j)%Z (twice m * (rho (i - j + m + 2)%Z m - rho (i - j + m)%Z m
          + phi * (rho (i + j - m + 2)%Z m - rho (i + j - m)%Z m)))
        + on (m =? j)%Z (phi * (1 - phi) * rho (i - j + m)%Z m - (1 - phi) * rho (i - j + m + 2)%Z m)
        + on (m =? j + 1)%Z (- (1 - phi) * (1 - phi) * rho (i - j + m)%Z m))).
      2, 3: reflexivity.
      2:{ intros m Hm. unfold layers, surface_weights. cbn [weigh w_a w_b w_c w_p w_q].
          decide_on; try (replace (j + 1 - Z.max m (j + 1))%Z with 0%Z by lia); ring. }
      rewrite !Sum_plus, Sum_up_to, !Sum_at, Sum_twice by lia.
      replace (_ * _ * _ * (_ / _))
        with (phi * (2 * r * tilt_plus G rho i j) - 2 * r * tilt_minus G rho (i + 2) j) by (field; lra).
      rewrite tilt_plus_is, tilt_minus_is by lia.
      normal_form. ring.
    - intros l Hl IH HM. rewrite change_plus_higher by lia.
      rewrite (Sum_eq 0 M 0 M _ (fun m =>
        weigh (layers i j (surface_weights l) m) m rho
        + (on (m <=? l)%Z (twice m * (rho (i - j + m - 2)%Z m - 2 * rho (i - j + m)%Z m + rho (i - j + m + 2)%Z m))
           + on (m =? l)%Z ((1 - phi) * (rho (i - j + m)%Z m - rho (i - j + m + 2)%Z m))
           + on (m =? l + 1)%Z ((1 - phi) * (rho (i - j + m - 2)%Z m - rho (i - j + m)%Z m))))).
      2, 3: reflexivity.
      2:{ intros m Hm. unfold layers, surface_weights. cbn [weigh w_a w_b w_c w_p w_q].
          replace (IZR (l + 1 - Z.max m (j + 1))) with (IZR (l - Z.max m (j + 1)) + 1)
            by (rewrite <- plus_IZR; f_equal; lia).
          decide_on; try (replace (l - Z.max m (j + 1))%Z with (-1)%Z by lia); ring. }
      rewrite Sum_plus, <- IH by lia. rewrite !Sum_plus, Sum_up_to, !Sum_at, Sum_twice by lia.
      replace (2 * r * (1 - phi * phi) * (_ - _))
        with (2 * r * (1 - phi * phi) * change_plus G rho l i j -
          (2 * r * tilt_minus G rho (i - j + l + 2) l - 2 * r * tilt_minus G rho (i - j + l) l))
        by (field; lra).
      rewrite !tilt_minus_is by lia.
      normal_form. ring.
  Qed.
End Surface.

(** A bulk load: the mean of the forms of all heights above the contact. *)
Definition averaged (j M : Z) (w : Z -> weights) : weights :=
  let mean f := Sum (j + 1) M f / IZR (M - j) in
  {| w_a m := mean (fun l => w_a (w l) m); w_b m := mean (fun l => w_b (w l) m);
     w_c m := mean (fun l => w_c (w l) m); w_p m := mean (fun l => w_p (w l) m);
     w_q m := mean (fun l => w_q (w l) m) |}.

Lemma averaged_weigh i j M w m rho :
  weigh (layers i j (averaged j M w) m) m rho =
  Sum (j + 1) M (fun l => weigh (layers i j (w l) m) m rho) / IZR (M - j).
Proof.
  unfold layers, averaged. cbn [weigh w_a w_b w_c w_p w_q].
  rewrite !Sum_plus, !Sum_times, (Sum_zero _ _ (fun _ => 0)) by auto. unfold Rdiv. ring.
Qed.

Theorem bulk_in_layers G rho i j M : (0 <= j < M)%Z ->
  2 * r G * (1 - phi G * phi G) *
    (Sum (j + 1) M (fun l => change_plus G rho l i j) / IZR (M - j)) =
  Sum 0 M (fun m => weigh (layers i j (averaged j M (surface_weights G j)) m) m rho).
Proof.
  intros H. rewrite (Sum_eq 0 M 0 M _ _ eq_refl eq_refl
    (fun m _ => averaged_weigh i j M (surface_weights G j) m rho)).
  rewrite Sum_over, <- Sum_swap. unfold Rdiv. rewrite <- Rmult_assoc. f_equal.
  rewrite <- Sum_scale. apply Sum_eq; auto. intros l Hl. apply surface_in_layers; lia.
Qed.

(** ** Squares *)

(** Where two weights of one layer stand on the same radius: near the contact alone. *)
Lemma overlap_is i j w m : overlap (layers i j w m) (layers i j w m) =
  w_a w m ^ 2 + w_b w m ^ 2 + w_c w m ^ 2 + w_p w m ^ 2 + w_q w m ^ 2
  + 2 * (on (m =? j - 1)%Z (w_c w m * w_p w m) + on (m =? j)%Z (w_b w m * w_p w m + w_c w m * w_q w m)
    + on (m =? j + 1)%Z (w_a w m * w_p w m + w_b w m * w_q w m) + on (m =? j + 2)%Z (w_a w m * w_q w m)).
Proof.
  unfold layers. cbn [overlap on_one_radius]. rewrite !Z.eqb_refl.
  generalize (w_a w m) (w_b w m) (w_c w m) (w_p w m) (w_q w m). intros a b c p q.
  destruct (Z.lt_ge_cases 2 (Z.abs (m - j))) as [H|H].
  - repeat match goal with |- context [(?x =? ?y)%Z] => replace (x =? y)%Z with false by lia end.
    unfold on. ring.
  - assert (C : (m = j - 2 \/ m = j - 1 \/ m = j \/ m = j + 1 \/ m = j + 2)%Z) by lia.
    destruct C as [->|[->|[->|[->| ->]]]]; compare_indices; unfold on; ring.
Qed.

Lemma overlap_at_most i j w m : overlap (layers i j w m) (layers i j w m) <=
  2 * (w_a w m ^ 2 + w_b w m ^ 2 + w_c w m ^ 2 + w_p w m ^ 2 + w_q w m ^ 2).
Proof.
  rewrite overlap_is. generalize (w_a w m) (w_b w m) (w_c w m) (w_p w m) (w_q w m). intros a b c p q.
  pose proof (pow2_ge_0 (a - p)). pose proof (pow2_ge_0 (b - p)). pose proof (pow2_ge_0 (c - p)).
  pose proof (pow2_ge_0 (a - q)). pose proof (pow2_ge_0 (b - q)). pose proof (pow2_ge_0 (c - q)).
  pose proof (pow2_ge_0 a). pose proof (pow2_ge_0 b). pose proof (pow2_ge_0 c).
  pose proof (pow2_ge_0 p). pose proof (pow2_ge_0 q). decide_on; lra.
Qed.

(** ** What Eq. 12 leaves out *)

(** The braces of Eq. 12 at a height l; nothing above it. *)
Definition braces_at (j l m : Z) : R := on (m <=? l)%Z (IZR (l - Z.max m j)).

Ltac real_bounds G :=
  pose proof (phi_above G); pose proof (phi_below G); pose proof (phi_squared_below G);
  pose proof (Rle_0_sqr (phi G)); unfold Rsqr in *.

Lemma Rabs_def2' x b : Rabs x <= b -> - b <= x <= b.
Proof. intros H. pose proof (Rle_abs x). pose proof (Rle_abs (- x)). rewrite Rabs_Ropp in *. lra. Qed.

(** What is left when the weights of Eq. 12 are taken away. *)
Definition less_main (w : weights) (main : Z -> R) : weights := {|
  w_a m := w_a w m - on (1 <=? m)%Z (2 * main m);
  w_b m := w_b w m - on (1 <=? m)%Z (-4 * main m);
  w_c m := w_c w m - on (1 <=? m)%Z (2 * main m);
  w_p := w_p w;
  w_q := w_q w |}.

Lemma less_main_weigh i j w main m rho :
  weigh (layers i j (less_main w main) m) m rho =
  weigh (layers i j w m) m rho + on (1 <=? m)%Z
    (2 * (main m * (2 * rho (i - j + m)%Z m - rho (i - j + m - 2)%Z m - rho (i - j + m + 2)%Z m))).
Proof.
  unfold layers, less_main. cbn [weigh w_a w_b w_c w_p w_q]. decide_on; ring.
Qed.

Lemma square_at_most x b : - b <= x <= b -> x ^ 2 <= b ^ 2.
Proof. intros H. assert (0 <= (b - x) * (b + x)) by (apply Rmult_le_pos; lra). lra. Qed.

Theorem left_out_squares G i j M : (0 <= j < M)%Z ->
  squares M (layers i j (less_main (surface_weights G j M) (braces_at j M))) <= 116 * (IZR M * IZR M).
Proof.
  intros H. real_bounds G. assert (One : 1 <= IZR M) by (apply (IZR_le 1); lia).
  assert (MM : 1 * IZR M <= IZR M * IZR M) by (apply Rmult_le_compat_r; lra).
  set (w := less_main _ _).
  assert (S : forall m b, 1 <= b -> - b <= w_a w m <= b -> - b <= w_b w m <= b -> - b <= w_c w m <= b ->
    - 1 <= w_p w m <= 1 -> - 1 <= w_q w m <= 1 ->
    overlap (layers i j w m) (layers i j w m) <= 2 * (3 * b ^ 2 + 2)).
  { intros m b Hb A B C P Q. eapply Rle_trans; [apply overlap_at_most|].
    apply square_at_most in A, B, C, P, Q. lra. }
  assert (Base : overlap (layers i j w 0) (layers i j w 0) <= 2 * (3 * (3 * IZR M) ^ 2 + 2)).
  { assert (N : 0 <= IZR (M - (j + 1)) <= IZR M - 1)
      by (rewrite <- minus_IZR; split; [apply (IZR_le 0)|apply IZR_le]; lia).
    apply S; unfold w, less_main, surface_weights; cbn [w_a w_b w_c w_p w_q]; change (twice 0) with 1;
      rewrite ?Z.max_r by lia; try lra; decide_on; lra. }
  assert (Other : forall m, (1 <= m <= M)%Z -> overlap (layers i j w m) (layers i j w m) <= 58).
  { intros m Hm. eapply Rle_trans; [apply (S m 3)|lra]; try lra;
      unfold w, less_main, surface_weights, braces_at, twice; cbn [w_a w_b w_c w_p w_q];
      (destruct (Z.le_gt_cases (j + 1) m);
       [rewrite ?Z.max_l by lia|rewrite ?Z.max_r by lia; rewrite ?minus_IZR, ?plus_IZR]; decide_on; lra). }
  unfold squares. rewrite Sum_first by lia. replace (0 + 1)%Z with 1%Z by lia.
  apply (Sum_le 1 M _ (fun _ => 58)) in Other. rewrite Sum_const in Other by lia.
  replace (M - 1 + 1)%Z with M in Other by lia. lra.
Qed.
