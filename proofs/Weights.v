(** The forces under surface and bulk loads as weights of single radii, layer by layer. *)

From Coq Require Import ZArith Reals Lia Lra List.
From ForceDiffusion Require Import Model Sums FirstOrder Lattice Geometry Forces Random.
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

(** ** One form under all loads of whole layers *)

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
  Variable G : lattice.
  Variable rho : radii.
  Variables i j : Z.
  Hypothesis base : (0 <= j)%Z.
  Local Notation phi := (phi G).
  Local Notation r := (r G).

  (** A height more adds the difference of two tilts: the sum over branches, by parts. *)
  Lemma surface_plus_higher M : (j < M)%Z ->
    surface_plus G rho (M + 1) i j = surface_plus G rho M i j
      - (tilt_minus G rho (i - j + M + 2) M - tilt_minus G rho (i - j + M) M) / (1 - phi * phi).
  Proof.
    intros H. pose proof (divisor_positive G). unfold surface_plus.
    replace (M + 1 - j - 1)%Z with (M - j)%Z by lia.
    rewrite (Sum_last 1 (M - j)) by lia.
    replace (M + 1 - 1)%Z with M by lia.
    same_values. field. lra.
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
    2 * r * (1 - phi * phi) * surface_plus G rho l i j =
    Sum 0 M (fun m => weigh (layers i j (surface_weights l) m) m rho).
  Proof.
    pose proof (divisor_positive G) as Hd. pose proof (r_pos G) as Hr.
    intros H. pattern l. apply (up_from _ (j + 1)); [| |lia]; clear l H.
    - intros HM. pose proof (surface_plus_top G rho (j + 1) i) as T.
      replace (j + 1 - 1)%Z with j in T by lia. rewrite T.
      rewrite (Sum_eq 0 M 0 M _ (fun m =>
        on (m <=? j)%Z (twice m * (rho (i - j + m + 2)%Z m - rho (i - j + m)%Z m
          + phi * (rho (i + j - m + 2)%Z m - rho (i + j - m)%Z m)))
        + on (m =? j)%Z (phi * (1 - phi) * rho (i - j + m)%Z m - (1 - phi) * rho (i - j + m + 2)%Z m)
        + on (m =? j + 1)%Z (- ((1 - phi) * (1 - phi)) * rho (i - j + m)%Z m))).
      2, 3: reflexivity.
      2:{ intros m Hm. unfold layers, surface_weights. cbn [weigh w_a w_b w_c w_p w_q].
          decide_on; try (replace (j + 1 - Z.max m (j + 1))%Z with 0%Z by lia); ring. }
      rewrite !Sum_plus, Sum_up_to, !Sum_at, Sum_twice by lia.
      replace (2 * r * (1 - phi * phi) * ((phi * tilt_plus G rho i j - tilt_minus G rho (i + 2) j) / (1 - phi * phi)))
        with (phi * (2 * r * tilt_plus G rho i j) - 2 * r * tilt_minus G rho (i + 2) j) by (field; lra).
      rewrite tilt_plus_is, tilt_minus_is by lia.
      rewrite Sum_plus, Sum_minus, Sum_scale, Sum_minus. same_sums. same_values. ring.
    - intros l Hl IH HM. rewrite surface_plus_higher by lia.
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
      replace (2 * r * (1 - phi * phi) * (surface_plus G rho l i j -
          (tilt_minus G rho (i - j + l + 2) l - tilt_minus G rho (i - j + l) l) / (1 - phi * phi)))
        with (2 * r * (1 - phi * phi) * surface_plus G rho l i j -
          (2 * r * tilt_minus G rho (i - j + l + 2) l - 2 * r * tilt_minus G rho (i - j + l) l))
        by (field; lra).
      rewrite !tilt_minus_is by lia.
      rewrite Sum_plus, Sum_minus, Sum_scale. same_sums. same_values. ring.
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
    (Sum (j + 1) M (fun l => surface_plus G rho l i j) / IZR (M - j)) =
  Sum 0 M (fun m => weigh (layers i j (averaged j M (surface_weights G j)) m) m rho).
Proof.
  intros H. rewrite (Sum_eq 0 M 0 M _ _ eq_refl eq_refl
    (fun m _ => averaged_weigh i j M (surface_weights G j) m rho)).
  rewrite Sum_over, <- Sum_swap. unfold Rdiv. rewrite <- Rmult_assoc. f_equal.
  rewrite <- Sum_scale. apply Sum_eq; auto. intros l Hl. apply surface_in_layers; lia.
Qed.

(** ** How near the weights are to those of Eq. 12 *)

Record near_main (M : Z) (w : weights) (main : Z -> R) : Prop := {
  main_bounds : forall m, (1 <= m <= M)%Z -> 0 <= main m <= IZR M;
  near_a : forall m, (1 <= m <= M)%Z -> Rabs (w_a w m - 2 * main m) <= 3;
  near_b : forall m, (1 <= m <= M)%Z -> Rabs (w_b w m - -4 * main m) <= 3;
  near_c : forall m, (1 <= m <= M)%Z -> Rabs (w_c w m - 2 * main m) <= 3;
  small_p : forall m, (0 <= m <= M)%Z -> Rabs (w_p w m) <= 1;
  small_q : forall m, (0 <= m <= M)%Z -> Rabs (w_q w m) <= 1;
  base_a : Rabs (w_a w 0%Z) <= 3 * IZR M;
  base_b : Rabs (w_b w 0%Z) <= 3 * IZR M;
  base_c : Rabs (w_c w 0%Z) <= 3 * IZR M
}.

(** The braces of Eq. 12 at a height l; nothing above it. *)
Definition braces_at (j l m : Z) : R := on (m <=? l)%Z (IZR (l - Z.max m j)).

Ltac real_bounds G :=
  pose proof (phi_above G); pose proof (phi_below G); pose proof (phi_squared_below G);
  pose proof (Rle_0_sqr (phi G)); unfold Rsqr in *.

Lemma surface_near_main G j M l : (0 <= j < l)%Z -> (l <= M)%Z ->
  near_main M (surface_weights G j l) (braces_at j l).
Proof.
  intros H HM. real_bounds G.
  assert (C : forall m, (j + 1 <= m)%Z -> (l - Z.max m (j + 1) = l - Z.max m j)%Z) by lia.
  assert (D : forall m, (m <= j)%Z -> IZR (l - Z.max m (j + 1)) = IZR (l - Z.max m j) - 1)
    by (intros; rewrite <- minus_IZR; f_equal; lia).
  assert (L : IZR l <= IZR M) by (apply IZR_le; lia).
  assert (One : 1 <= IZR l) by (apply (IZR_le 1); lia).
  split.
  - intros m Hm. unfold braces_at, on. destruct (m <=? l)%Z eqn:E.
    + split; [apply (IZR_le 0)|apply IZR_le]; lia.
    + split; [lra|apply (IZR_le 0); lia].
  - intros m Hm. unfold surface_weights, braces_at, twice. cbn [w_a]. replace (m =? 0)%Z with false by lia.
    apply Rabs_le. destruct (Z.le_gt_cases (j + 1) m); [rewrite C by lia|rewrite D by lia]; decide_on; lra.
  - intros m Hm. unfold surface_weights, braces_at, twice. cbn [w_b]. replace (m =? 0)%Z with false by lia.
    apply Rabs_le. destruct (Z.le_gt_cases (j + 1) m); [rewrite C by lia|rewrite D by lia]; decide_on; lra.
  - intros m Hm. unfold surface_weights, braces_at, twice. cbn [w_c]. replace (m =? 0)%Z with false by lia.
    apply Rabs_le. destruct (Z.le_gt_cases (j + 1) m); [rewrite C by lia|rewrite D by lia]; decide_on; lra.
  - intros m Hm. unfold surface_weights, twice. cbn [w_p]. apply Rabs_le. decide_on; lra.
  - intros m Hm. unfold surface_weights, twice. cbn [w_q]. apply Rabs_le. decide_on; lra.
  - unfold surface_weights. cbn [w_a]. change (twice 0) with 1. rewrite D by lia.
    assert (0 <= IZR (l - Z.max 0 j) <= IZR l) by (split; [apply (IZR_le 0)|apply IZR_le]; lia).
    assert (1 <= IZR (l - Z.max 0 j)) by (apply (IZR_le 1); lia).
    apply Rabs_le. decide_on; lra.
  - unfold surface_weights. cbn [w_b]. change (twice 0) with 1. rewrite D by lia.
    assert (0 <= IZR (l - Z.max 0 j) <= IZR l) by (split; [apply (IZR_le 0)|apply IZR_le]; lia).
    assert (1 <= IZR (l - Z.max 0 j)) by (apply (IZR_le 1); lia).
    apply Rabs_le. decide_on; lra.
  - unfold surface_weights. cbn [w_c]. change (twice 0) with 1. rewrite D by lia.
    assert (0 <= IZR (l - Z.max 0 j) <= IZR l) by (split; [apply (IZR_le 0)|apply IZR_le]; lia).
    assert (1 <= IZR (l - Z.max 0 j)) by (apply (IZR_le 1); lia).
    apply Rabs_le. decide_on; lra.
Qed.

(** Means of what is near are near. *)
Lemma mean_near j M (f g : Z -> R) b : (j < M)%Z ->
  (forall l, (j + 1 <= l <= M)%Z -> Rabs (f l - g l) <= b) ->
  Rabs (Sum (j + 1) M f / IZR (M - j) - Sum (j + 1) M g / IZR (M - j)) <= b.
Proof.
  intros H B. assert (P : 0 < IZR (M - j)) by (apply (IZR_lt 0); lia).
  replace (Sum (j + 1) M f / IZR (M - j) - Sum (j + 1) M g / IZR (M - j))
    with (Sum (j + 1) M (fun l => f l - g l) / IZR (M - j)) by (rewrite Sum_minus; field; lra).
  unfold Rdiv. rewrite Rabs_mult, (Rabs_right (/ _)) by (apply Rle_ge, Rlt_le, Rinv_0_lt_compat, P).
  apply (Rmult_le_reg_r (IZR (M - j))); [exact P|].
  rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
  eapply Rle_trans; [apply Sum_abs|].
  eapply Rle_trans; [apply (Sum_le _ _ _ (fun _ => b)); exact B|].
  rewrite Sum_const by lia. replace (M - (j + 1) + 1)%Z with (M - j)%Z by lia. lra.
Qed.

Lemma mean_scale j M a (f : Z -> R) : Sum (j + 1) M (fun l => a * f l) / IZR (M - j) =
  a * (Sum (j + 1) M f / IZR (M - j)).
Proof. rewrite Sum_scale. unfold Rdiv. ring. Qed.

Lemma mean_small j M (f : Z -> R) b : (j < M)%Z ->
  (forall l, (j + 1 <= l <= M)%Z -> Rabs (f l) <= b) ->
  Rabs (Sum (j + 1) M f / IZR (M - j)) <= b.
Proof.
  intros H B. pose proof (mean_near j M f (fun _ => 0) b H) as N.
  rewrite (Sum_zero _ _ (fun _ => 0)) in N by auto. unfold Rdiv at 2 in N.
  rewrite Rmult_0_l, Rminus_0_r in N. apply N. intros l Hl. rewrite Rminus_0_r. apply B, Hl.
Qed.

Definition mean_braces (j M m : Z) : R := Sum (j + 1) M (fun l => braces_at j l m) / IZR (M - j).

Lemma bulk_near_main G j M : (0 <= j < M)%Z ->
  near_main M (averaged j M (surface_weights G j)) (mean_braces j M).
Proof.
  intros H. assert (S : forall l, (j + 1 <= l <= M)%Z -> near_main M (surface_weights G j l) (braces_at j l))
    by (intros; apply surface_near_main; lia).
  assert (P : 0 < IZR (M - j)) by (apply (IZR_lt 0); lia).
  split.
  - intros m Hm. unfold mean_braces. split.
    + apply Rmult_le_pos; [|apply Rlt_le, Rinv_0_lt_compat, P].
      rewrite <- (Sum_zero (j + 1) M (fun _ => 0)) by auto. apply Sum_le. intros l Hl.
      apply (main_bounds _ _ _ (S l Hl) m Hm).
    + eapply Rle_trans; [apply Rle_abs|]. apply mean_small; [lia|]. intros l Hl.
      pose proof (main_bounds _ _ _ (S l Hl) m Hm). rewrite Rabs_right; lra.
  - intros m Hm. unfold averaged, mean_braces. cbn [w_a]. rewrite <- mean_scale.
    apply mean_near; [lia|]. intros l Hl. apply (near_a _ _ _ (S l Hl) m Hm).
  - intros m Hm. unfold averaged, mean_braces. cbn [w_b]. rewrite <- mean_scale.
    apply mean_near; [lia|]. intros l Hl. apply (near_b _ _ _ (S l Hl) m Hm).
  - intros m Hm. unfold averaged, mean_braces. cbn [w_c]. rewrite <- mean_scale.
    apply mean_near; [lia|]. intros l Hl. apply (near_c _ _ _ (S l Hl) m Hm).
  - intros m Hm. apply mean_small; [lia|]. intros l Hl. apply (small_p _ _ _ (S l Hl) m Hm).
  - intros m Hm. apply mean_small; [lia|]. intros l Hl. apply (small_q _ _ _ (S l Hl) m Hm).
  - apply mean_small; [lia|]. intros l Hl. apply (base_a _ _ _ (S l Hl)).
  - apply mean_small; [lia|]. intros l Hl. apply (base_b _ _ _ (S l Hl)).
  - apply mean_small; [lia|]. intros l Hl. apply (base_c _ _ _ (S l Hl)).
Qed.

(** ** Squares of near weights *)

Lemma Rabs_def2' x b : Rabs x <= b -> - b <= x <= b.
Proof. intros H. pose proof (Rle_abs x). pose proof (Rle_abs (- x)). rewrite Rabs_Ropp in *. lra. Qed.

Lemma product_bounds (t : bool) x y : Rabs y <= 1 -> - Rabs x <= (if t then x * y else 0) <= Rabs x.
Proof.
  intros Hy. pose proof (Rabs_pos x). destruct t; [|lra].
  assert (B : Rabs (x * y) <= Rabs x).
  { rewrite Rabs_mult. rewrite <- (Rmult_1_r (Rabs x)) at 2. apply Rmult_le_compat_l; assumption. }
  pose proof (Rle_abs (x * y)). pose proof (Rle_abs (- (x * y))). rewrite Rabs_Ropp in *. lra.
Qed.

Lemma square_small y : Rabs y <= 1 -> 0 <= y * y <= 1.
Proof.
  intros H. pose proof (product_bounds true y y H). pose proof (Rle_0_sqr y). unfold Rsqr in *. lra.
Qed.

(** In one layer the three places of one diagonal differ, and so do the two of the other. *)
Lemma layer_square i j w m : Rabs (w_p w m) <= 1 -> Rabs (w_q w m) <= 1 ->
  Rabs (overlap (layers i j w m) (layers i j w m)
    - (w_a w m * w_a w m + w_b w m * w_b w m + w_c w m * w_c w m))
  <= 2 + 4 * (Rabs (w_a w m) + Rabs (w_b w m) + Rabs (w_c w m)).
Proof.
  intros Hp Hq. unfold layers. cbn [overlap meet].
  set (a := w_a w m). set (b := w_b w m). set (c := w_c w m).
  set (p := w_p w m) in *. set (q := w_q w m) in *.
  set (A := (i - j + m - 2)%Z). set (C := (i - j + m + 2)%Z). set (B := (i - j + m)%Z).
  set (Q := (i + j - m + 2)%Z). set (P := (i + j - m)%Z).
  rewrite !Z.eqb_refl.
  replace (A =? B)%Z with false by lia. replace (A =? C)%Z with false by lia.
  replace (B =? A)%Z with false by lia. replace (B =? C)%Z with false by lia.
  replace (C =? A)%Z with false by lia. replace (C =? B)%Z with false by lia.
  replace (P =? Q)%Z with false by lia. replace (Q =? P)%Z with false by lia.
  rewrite (Z.eqb_sym P A), (Z.eqb_sym P B), (Z.eqb_sym P C).
  rewrite (Z.eqb_sym Q A), (Z.eqb_sym Q B), (Z.eqb_sym Q C).
  rewrite (Rmult_comm p a), (Rmult_comm p b), (Rmult_comm p c).
  rewrite (Rmult_comm q a), (Rmult_comm q b), (Rmult_comm q c).
  pose proof (product_bounds (A =? P)%Z a p Hp). pose proof (product_bounds (A =? Q)%Z a q Hq).
  pose proof (product_bounds (B =? P)%Z b p Hp). pose proof (product_bounds (B =? Q)%Z b q Hq).
  pose proof (product_bounds (C =? P)%Z c p Hp). pose proof (product_bounds (C =? Q)%Z c q Hq).
  pose proof (square_small p Hp). pose proof (square_small q Hq).
  apply Rabs_le. lra.
Qed.

(** (x + d)² beside x², |d| ≤ 3. *)
Lemma square_near w x : Rabs (w - x) <= 3 -> Rabs (w * w - x * x) <= 6 * Rabs x + 9 /\ Rabs w <= Rabs x + 3.
Proof.
  intros H. assert (T : Rabs w <= Rabs x + 3).
  { replace w with (x + (w - x)) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra. }
  split; [|exact T].
  replace (w * w - x * x) with ((w - x) * (w + x)) by ring. rewrite Rabs_mult.
  eapply Rle_trans; [apply Rmult_le_compat; [apply Rabs_pos|apply Rabs_pos|exact H|apply Rabs_triang]|].
  lra.
Qed.

Section Near.
  Variables M i j : Z.
  Variable w : weights.
  Variable main : Z -> R.
  Hypothesis high : (1 <= M)%Z.
  Hypothesis N : near_main M w main.

  Lemma layer_near m : (1 <= m <= M)%Z ->
    Rabs (overlap (layers i j w m) (layers i j w m) - 24 * (main m * main m)) <= 145 * IZR M.
  Proof.
    intros Hm. assert (One : 1 <= IZR M) by (apply (IZR_le 1); exact high).
    pose proof (main_bounds _ _ _ N m Hm) as [L U].
    destruct (square_near _ _ (near_a _ _ _ N m Hm)) as [A1 A2].
    destruct (square_near _ _ (near_b _ _ _ N m Hm)) as [B1 B2].
    destruct (square_near _ _ (near_c _ _ _ N m Hm)) as [C1 C2].
    pose proof (layer_square i j w m (small_p _ _ _ N m ltac:(lia)) (small_q _ _ _ N m ltac:(lia))) as S.
    rewrite (Rabs_right (2 * main m)) in * by lra. rewrite (Rabs_left1 (-4 * main m)) in * by lra.
    apply Rabs_le. apply Rabs_def2' in A1. apply Rabs_def2' in B1. apply Rabs_def2' in C1.
    apply Rabs_def2' in S. lra.
  Qed.

  Lemma base_near : Rabs (overlap (layers i j w 0) (layers i j w 0)) <= 65 * (IZR M * IZR M).
  Proof.
    assert (One : 1 <= IZR M) by (apply (IZR_le 1); exact high).
    assert (MM : 1 * IZR M <= IZR M * IZR M) by (apply Rmult_le_compat_r; lra).
    pose proof (layer_square i j w 0 (small_p _ _ _ N 0%Z ltac:(lia)) (small_q _ _ _ N 0%Z ltac:(lia))) as S.
    assert (Sq : forall x, Rabs x <= 3 * IZR M -> 0 <= x * x <= 9 * (IZR M * IZR M)).
    { intros x Hx. split; [apply Rle_0_sqr|].
      rewrite <- (Rabs_right (x * x)) by (apply Rle_ge, Rle_0_sqr). rewrite Rabs_mult.
      eapply Rle_trans; [apply Rmult_le_compat; [apply Rabs_pos|apply Rabs_pos|exact Hx|exact Hx]|].
      lra. }
    pose proof (base_a _ _ _ N) as A. pose proof (base_b _ _ _ N) as B. pose proof (base_c _ _ _ N) as C.
    pose proof (Sq _ A). pose proof (Sq _ B). pose proof (Sq _ C).
    apply Rabs_le. apply Rabs_def2' in S. lra.
  Qed.

  Theorem squares_near :
    Rabs (squares M (layers i j w) - 24 * Sum 1 M (fun m => main m * main m)) <= 210 * (IZR M * IZR M).
  Proof.
    unfold squares. rewrite Sum_first by lia. replace (0 + 1)%Z with 1%Z by lia.
    rewrite <- Sum_scale.
    replace (_ + _ - _) with (overlap (layers i j w 0) (layers i j w 0) +
      Sum 1 M (fun m => overlap (layers i j w m) (layers i j w m) - 24 * (main m * main m)))
      by (rewrite Sum_minus; ring).
    eapply Rle_trans; [apply Rabs_triang|].
    assert (S : Rabs (Sum 1 M (fun m => overlap (layers i j w m) (layers i j w m) - 24 * (main m * main m)))
      <= 145 * (IZR M * IZR M)).
    { eapply Rle_trans; [apply Sum_abs|].
      eapply Rle_trans; [apply (Sum_le _ _ _ (fun _ => 145 * IZR M)); exact layer_near|].
      rewrite Sum_const by lia. replace (M - 1 + 1)%Z with M by lia. lra. }
    pose proof base_near. lra.
  Qed.
End Near.

(** What is left when the weights of Eq. 12 are taken away. *)
Definition less_main (w : weights) (main : Z -> R) : weights := {|
  w_a m := w_a w m - on (1 <=? m)%Z (2 * main m);
  w_b m := w_b w m - on (1 <=? m)%Z (-4 * main m);
  w_c m := w_c w m - on (1 <=? m)%Z (2 * main m);
  w_p := w_p w;
  w_q := w_q w |}.

Lemma less_main_near M w main : (1 <= M)%Z -> near_main M w main ->
  near_main M (less_main w main) (fun _ => 0).
Proof.
  intros H N. assert (One : 1 <= IZR M) by (apply (IZR_le 1); exact H).
  split; cbn [less_main w_a w_b w_c w_p w_q].
  - intros. lra.
  - intros m Hm. unfold on. replace (1 <=? m)%Z with true by lia.
    rewrite Rmult_0_r, Rminus_0_r. apply (near_a _ _ _ N m Hm).
  - intros m Hm. unfold on. replace (1 <=? m)%Z with true by lia.
    rewrite Rmult_0_r, Rminus_0_r. apply (near_b _ _ _ N m Hm).
  - intros m Hm. unfold on. replace (1 <=? m)%Z with true by lia.
    rewrite Rmult_0_r, Rminus_0_r. apply (near_c _ _ _ N m Hm).
  - apply (small_p _ _ _ N).
  - apply (small_q _ _ _ N).
  - unfold on. cbn. rewrite Rminus_0_r. apply (base_a _ _ _ N).
  - unfold on. cbn. rewrite Rminus_0_r. apply (base_b _ _ _ N).
  - unfold on. cbn. rewrite Rminus_0_r. apply (base_c _ _ _ N).
Qed.

Lemma less_main_weigh i j w main m rho :
  weigh (layers i j (less_main w main) m) m rho =
  weigh (layers i j w m) m rho + on (1 <=? m)%Z
    (2 * (main m * (2 * rho (i - j + m)%Z m - rho (i - j + m - 2)%Z m - rho (i - j + m + 2)%Z m))).
Proof.
  unfold layers, less_main. cbn [weigh w_a w_b w_c w_p w_q]. decide_on; ring.
Qed.

(** ** Sums of the squares of the main weights *)

Lemma sum_of_squares n : (0 <= n)%Z ->
  Sum 1 n (fun m => IZR m * IZR m) = IZR n * (IZR n + 1) * (2 * IZR n + 1) / 6.
Proof.
  intros H. pattern n. apply (up_from _ 0); [| |exact H].
  - rewrite Sum_empty by lia. field.
  - intros m Hm IH. rewrite Sum_last by lia. replace (m + 1 - 1)%Z with m by lia.
    rewrite IH, plus_IZR. field.
Qed.

Lemma sum_of_products n : (0 <= n)%Z ->
  Sum 1 n (fun m => IZR m * (IZR m + 1) * (IZR m * (IZR m + 1))) =
  IZR n * (IZR n + 1) * (IZR n + 2) * (3 * (IZR n * IZR n) + 6 * IZR n + 1) / 15.
Proof.
  intros H. pattern n. apply (up_from _ 0); [| |exact H].
  - rewrite Sum_empty by lia. field.
  - intros m Hm IH. rewrite Sum_last by lia. replace (m + 1 - 1)%Z with m by lia.
    rewrite IH, plus_IZR. field.
Qed.

(** Counting a sum from its upper end. *)
Lemma Sum_reverse n f : (0 <= n)%Z -> Sum 1 n (fun m => f (n + 1 - m)%Z) = Sum 1 n f.
Proof.
  intros H. pattern n. apply (up_from _ 0); [| |exact H].
  - rewrite !Sum_empty by lia. reflexivity.
  - intros m Hm IH. rewrite Sum_first, Sum_next by lia.
    rewrite (Sum_last 1 (m + 1) f) by lia. rewrite Rplus_comm. f_equal.
    + replace (m + 1 - 1)%Z with m by lia. rewrite <- IH. apply Sum_eq; auto. intros. f_equal. lia.
    + f_equal. lia.
Qed.

Lemma braces_squares j M : (0 <= j < M)%Z ->
  Sum 1 M (fun m => braces_at j M m * braces_at j M m) =
  IZR j * (IZR (M - j) * IZR (M - j)) +
  (IZR (M - j) - 1) * IZR (M - j) * (2 * IZR (M - j) - 1) / 6.
Proof.
  intros H. rewrite (Sum_split 1 j M) by lia. f_equal.
  - rewrite (Sum_eq 1 j 1 j _ (fun _ => IZR (M - j) * IZR (M - j))); auto.
    + rewrite Sum_const by lia. replace (j - 1 + 1)%Z with j by lia. reflexivity.
    + intros m Hm. unfold braces_at, on. replace (m <=? M)%Z with true by lia.
      replace (M - Z.max m j)%Z with (M - j)%Z by lia. reflexivity.
  - rewrite (Sum_last (j + 1) M) by lia.
    unfold braces_at at 3 4, on. replace (M <=? M)%Z with true by lia.
    replace (M - Z.max M j)%Z with 0%Z by lia. rewrite Rmult_0_l, Rplus_0_r.
    replace (Sum (j + 1) (M - 1) _) with (Sum 1 (M - j - 1) (fun m => IZR m * IZR m)).
    + rewrite sum_of_squares by lia. rewrite !minus_IZR. field.
    + rewrite <- (Sum_reverse (M - j - 1)) by lia.
      replace (j + 1)%Z with (1 + j)%Z by lia. replace (M - 1)%Z with (M - j - 1 + j)%Z by lia.
      rewrite <- Sum_shift. apply Sum_eq; auto. intros m Hm.
      unfold braces_at, on. replace (m + j <=? M)%Z with true by lia.
      replace (M - Z.max (m + j) j)%Z with (M - j - 1 + 1 - m)%Z by lia. reflexivity.
Qed.

(** The mean of the braces over all heights above the contact. *)
Lemma mean_braces_is j M m : (0 <= j < M)%Z -> (1 <= m <= M)%Z ->
  mean_braces j M m = if (m <=? j)%Z then (IZR (M - j) + 1) / 2
    else IZR (M - m) * (IZR (M - m) + 1) / (2 * IZR (M - j)).
Proof.
  intros H Hm. unfold mean_braces.
  assert (P : 0 < IZR (M - j)) by (apply (IZR_lt 0); lia).
  assert (T : forall n, (0 <= n)%Z -> Sum 1 n IZR = IZR n * (IZR n + 1) / 2).
  { intros n Hn. pattern n. apply (up_from _ 0); [| |exact Hn].
    - rewrite Sum_empty by lia. field.
    - intros k Hk IH. rewrite Sum_last by lia. replace (k + 1 - 1)%Z with k by lia.
      rewrite IH, plus_IZR. field. }
  destruct (m <=? j)%Z eqn:E.
  - rewrite (Sum_eq (j + 1) M (1 + j) (M - j + j) _ (fun l => IZR (l - j))); [|lia|lia|].
    + rewrite <- (Sum_shift 1 (M - j) j (fun l => IZR (l - j))).
      rewrite (Sum_eq 1 (M - j) 1 (M - j) _ IZR); auto; [|intros; f_equal; lia].
      rewrite T by lia. field. lra.
    + intros l Hl. unfold braces_at, on. replace (m <=? l)%Z with true by lia.
      f_equal. lia.
  - rewrite (Sum_split (j + 1) m M) by lia.
    rewrite (Sum_zero (j + 1) m).
    2:{ intros l Hl. unfold braces_at, on. destruct (m <=? l)%Z eqn:El; auto.
        replace (l - Z.max m j)%Z with 0%Z by lia. reflexivity. }
    rewrite (Sum_eq (m + 1) M (1 + m) (M - m + m) _ (fun l => IZR (l - m))); [|lia|lia|].
    + rewrite <- (Sum_shift 1 (M - m) m (fun l => IZR (l - m))).
      rewrite (Sum_eq 1 (M - m) 1 (M - m) _ IZR); auto; [|intros; f_equal; lia].
      rewrite T by lia. field. lra.
    + intros l Hl. unfold braces_at, on. replace (m <=? l)%Z with true by lia. f_equal. lia.
Qed.

Lemma mean_braces_squares j M : (0 <= j < M)%Z ->
  Sum 1 M (fun m => mean_braces j M m * mean_braces j M m) =
  IZR j * ((IZR (M - j) + 1) * (IZR (M - j) + 1)) / 4 +
  (IZR (M - j) * IZR (M - j) - 1) * (3 * (IZR (M - j) * IZR (M - j)) - 2) / (60 * IZR (M - j)).
Proof.
  intros H. assert (P : 0 < IZR (M - j)) by (apply (IZR_lt 0); lia).
  rewrite (Sum_split 1 j M) by lia. f_equal.
  - rewrite (Sum_eq 1 j 1 j _ (fun _ => (IZR (M - j) + 1) / 2 * ((IZR (M - j) + 1) / 2))); auto.
    + rewrite Sum_const by lia. replace (j - 1 + 1)%Z with j by lia. field.
    + intros m Hm. rewrite mean_braces_is by lia. replace (m <=? j)%Z with true by lia. reflexivity.
  - rewrite (Sum_last (j + 1) M), (mean_braces_is j M M) by lia.
    replace (M <=? j)%Z with false by lia. replace (M - M)%Z with 0%Z by lia.
    replace (Sum (j + 1) (M - 1) _) with
      (Sum 1 (M - j - 1) (fun m => IZR m * (IZR m + 1) * (IZR m * (IZR m + 1))) / (4 * (IZR (M - j) * IZR (M - j)))).
    + rewrite sum_of_products by lia. rewrite !minus_IZR in *. field. lra.
    + rewrite <- (Sum_reverse (M - j - 1)) by lia. rewrite <- Sum_over.
      replace (j + 1)%Z with (1 + j)%Z by lia. replace (M - 1)%Z with (M - j - 1 + j)%Z by lia.
      rewrite <- Sum_shift. apply Sum_eq; auto. intros m Hm.
      rewrite mean_braces_is by lia. replace (m + j <=? j)%Z with false by lia.
      replace (M - j - 1 + 1 - m)%Z with (M - (m + j))%Z by lia. field. lra.
Qed.
