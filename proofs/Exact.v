(** The squared weights of the forces under surface and bulk loads, added up exactly for every contact.
    What stands below the contact is one affine form under both loads; what stands above is summed by
    certificates: each sum's difference is its term. *)

From Coq Require Import ZArith Reals Lia Lra List.
From ForceDiffusion Require Import Model Sums FirstOrder Lattice Geometry Mirror Forces Random Weights.
Import ListNotations.

Open Scope R_scope.
Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.

Lemma Sum_telescope (F : Z -> R) low high f : (low <= high + 1)%Z ->
  (forall m, (low <= m <= high)%Z -> f m = F m - F (m - 1)%Z) ->
  Sum low high f = F high - F (low - 1)%Z.
Proof.
  intros H. replace high with (high + 1 - 1)%Z by lia. revert H. generalize (high + 1)%Z as n.
  intros n H. pattern n. apply (up_from _ low); [| |exact H]; clear n H.
  - intros _. rewrite Sum_empty by lia. ring.
  - intros n Hn IH E. replace (n + 1 - 1)%Z with n by lia.
    rewrite Sum_last, IH, E by (intros; try apply E; lia). ring.
Qed.

Section Squares.
  Context (G : lattice) (i j M : Z) (base : (0 <= j)%Z) (top : (j < M)%Z).
  Local Notation phi := (phi G).
  Local Notation K := (IZR (M - j)).
  Local Notation over w m := (overlap (layers i j w m) (layers i j w m)).

  (** ** Below the contact *)

  (** Weights that are as if the load were N + 1 layers above the contact. *)
  Definition below_contact (N : R) (w : weights) : Prop := forall m, (0 <= m <= j)%Z ->
    w_a w m = twice m * N /\
    w_b w m = - (2 * twice m * N + twice m) + on (m =? j)%Z (phi * (1 - phi)) /\
    w_c w m = twice m * N + twice m - on (m =? j)%Z (1 - phi) /\
    w_p w m = - (phi * twice m) /\ w_q w m = phi * twice m.

  Definition plain (N : R) : R := N ^ 2 + (2 * N + 1) ^ 2 + (N + 1) ^ 2 + 2 * phi ^ 2.
  Definition beside (N s : R) : R :=
    (s * N) ^ 2 + (- (2 * s * N + s) + phi * (1 - phi)) ^ 2 + (s * N + s - (1 - phi)) ^ 2
    + 2 * (phi * s) ^ 2 + 2 * (phi * s * (3 * s * N + 2 * s - (1 - phi) - phi * (1 - phi))).
  Definition below_squares (N : R) : R :=
    beside N (twice j) + on (1 <=? j)%Z (twice (j - 1) ^ 2 * (plain N - 2 * phi * (N + 1)))
    + on (2 <=? j)%Z (plain N * (4 * IZR j - 7)).

  Lemma squares_below N w : below_contact N w -> Sum 0 j (fun m => over w m) = below_squares N.
  Proof.
    intros H.
    assert (Far : forall m, (0 <= m <= j - 2)%Z -> over w m = twice m ^ 2 * plain N).
    { intros m Hm. rewrite overlap_is. destruct (H m ltac:(lia)) as (-> & -> & -> & -> & ->).
      unfold plain. decide_on; ring. }
    assert (At : over w j = beside N (twice j)).
    { rewrite overlap_is. destruct (H j ltac:(lia)) as (-> & -> & -> & -> & ->).
      unfold beside. decide_on; ring. }
    unfold below_squares. rewrite Sum_last, At by lia.
    destruct (Z.eq_dec j 0) as [E|E]; [rewrite Sum_empty by lia; decide_on; ring|].
    assert (Before : over w (j - 1)%Z = twice (j - 1) ^ 2 * (plain N - 2 * phi * (N + 1))).
    { rewrite overlap_is. destruct (H (j - 1)%Z ltac:(lia)) as (-> & -> & -> & -> & ->).
      unfold plain. decide_on; ring. }
    rewrite (Sum_last 0 (j - 1)), Before by lia.
    destruct (Z.eq_dec j 1) as [E'|E']; [rewrite Sum_empty by lia; decide_on; ring|].
    replace (j - 1 - 1)%Z with (j - 2)%Z by lia.
    rewrite Sum_first, Far by lia. rewrite (Sum_eq _ _ 1 (j - 2) _ (fun _ => 4 * plain N)).
    - rewrite Sum_const by lia. rewrite plus_IZR, !minus_IZR. unfold twice at 1. cbn [Z.eqb].
      decide_on; ring.
    - reflexivity.
    - reflexivity.
    - intros m Hm. rewrite Far by lia. unfold twice. replace (m =? 0)%Z with false by lia. ring.
  Qed.

  Lemma surface_below l : (j < l)%Z -> below_contact (IZR (l - (j + 1))) (surface_weights G j l).
  Proof.
    intros Hl m Hm. unfold surface_weights. cbn [w_a w_b w_c w_p w_q].
    replace (Z.max m (j + 1)) with (j + 1)%Z by lia. repeat split; decide_on; ring.
  Qed.

  Lemma mean_affine a b (f : Z -> R) : (forall l, (j + 1 <= l <= M)%Z -> f l = a * IZR (l - (j + 1)) + b) ->
    Sum (j + 1) M f / K = a * ((K - 1) / 2) + b.
  Proof.
    intros H. assert (P : 0 < K) by (apply (IZR_lt 0); lia).
    rewrite (Sum_telescope (fun l => a * (IZR (l - j) * (IZR (l - j) - 1) / 2) + b * IZR (l - j))).
    - replace (j + 1 - 1 - j)%Z with 0%Z by lia. field. lra.
    - lia.
    - intros l Hl. rewrite H by lia. rewrite !minus_IZR, plus_IZR. field.
  Qed.

  Lemma bulk_below : below_contact ((K - 1) / 2) (averaged j M (surface_weights G j)).
  Proof.
    intros m Hm. unfold averaged. cbn [w_a w_b w_c w_p w_q].
    repeat split.
    - rewrite (mean_affine (twice m) 0); [ring|].
      intros l Hl. destruct (surface_below l ltac:(lia) m Hm) as (-> & _). ring.
    - rewrite (mean_affine (- 2 * twice m) (- twice m + on (m =? j)%Z (phi * (1 - phi)))); [ring|].
      intros l Hl. destruct (surface_below l ltac:(lia) m Hm) as (_ & -> & _). ring.
    - rewrite (mean_affine (twice m) (twice m - on (m =? j)%Z (1 - phi))); [ring|].
      intros l Hl. destruct (surface_below l ltac:(lia) m Hm) as (_ & _ & -> & _). ring.
    - rewrite (mean_affine 0 (- (phi * twice m))); [ring|].
      intros l Hl. destruct (surface_below l ltac:(lia) m Hm) as (_ & _ & _ & -> & _). ring.
    - rewrite (mean_affine 0 (phi * twice m)); [ring|].
      intros l Hl. destruct (surface_below l ltac:(lia) m Hm) as (_ & _ & _ & _ & ->). ring.
  Qed.

  (** ** Above it *)

  Definition above_contact (w : weights) : Prop := forall m, (j + 1 <= m <= M)%Z -> w_p w m = 0 /\ w_q w m = 0.

  Lemma squares_split w : above_contact w ->
    squares M (layers i j w) = Sum 0 j (fun m => over w m)
      + (w_a w (j + 1)%Z ^ 2 + w_b w (j + 1)%Z ^ 2 + w_c w (j + 1)%Z ^ 2)
      + Sum (j + 2) M (fun m => w_a w m ^ 2 + w_b w m ^ 2 + w_c w m ^ 2).
  Proof.
    intros H. assert (E : forall m, (j + 1 <= m <= M)%Z -> over w m = w_a w m ^ 2 + w_b w m ^ 2 + w_c w m ^ 2).
    { intros m Hm. rewrite overlap_is. destruct (H m Hm) as [-> ->]. decide_on; ring. }
    unfold squares. rewrite (Sum_split 0 j M) by lia. rewrite (Sum_first (j + 1) M), E by lia.
    replace (j + 1 + 1)%Z with (j + 2)%Z by lia.
    rewrite (Sum_eq (j + 2) M _ _ _ _ eq_refl eq_refl (fun m Hm => E m ltac:(lia))). ring.
  Qed.

  Definition surface_squares : R :=
    below_squares (K - 1)
    + ((2 * (K - 1)) ^ 2 + (- 4 * (K - 1) + on (j + 2 <=? M)%Z (1 - phi) - (1 - phi) ^ 2) ^ 2
       + (2 * (K - 1) - on (j + 2 <=? M)%Z (1 - phi)) ^ 2)
    + 2 * (K - 1) * (4 * K ^ 2 - 14 * K + phi ^ 2 - 2 * phi + 13).

  Theorem surface_squares_are : squares M (layers i j (surface_weights G j M)) = surface_squares.
  Proof.
    rewrite squares_split.
    2:{ intros m Hm. unfold surface_weights. cbn [w_p w_q]. decide_on; split; ring. }
    rewrite (squares_below (K - 1)).
    2:{ replace (K - 1) with (IZR (M - (j + 1))) by (rewrite !minus_IZR, plus_IZR; ring).
        apply surface_below; lia. }
    unfold surface_squares. f_equal; [f_equal|].
    - unfold surface_weights. cbn [w_a w_b w_c]. rewrite Z.max_id. unfold twice.
      rewrite !minus_IZR, plus_IZR. decide_on; ring.
    - rewrite (Sum_telescope (fun m => 8 * (IZR (M - j - 2) ^ 3 - IZR (M - m - 1) ^ 3)
        + 12 * (IZR (M - j - 2) ^ 2 - IZR (M - m - 1) ^ 2)
        + (4 + 2 * (1 - phi) ^ 2) * (IZR (M - j - 2) - IZR (M - m - 1)))).
      + rewrite !minus_IZR, !plus_IZR. ring.
      + lia.
      + intros m Hm. unfold surface_weights. cbn [w_a w_b w_c].
        replace (Z.max m (j + 1)) with m by lia. unfold twice. decide_on;
          try (replace m with M in * by lia); rewrite !minus_IZR, ?minus_IZR; ring.
  Qed.

  Definition bulk_squares : R :=
    below_squares ((K - 1) / 2)
    + ((K - 1) ^ 2 + (- 2 * (K - 1) + (1 - phi) * (K - 1) / K - (1 - phi) ^ 2) ^ 2
       + ((K - 1) * (K - 1 + phi) / K) ^ 2)
    + (6 / 5 * (K - 1) ^ 5 + (2 / 3 * phi ^ 2 - 10 / 3 * phi + 2 / 3) * (K - 1) ^ 3
       + (4 / 3 * phi ^ 2 - 2 / 3 * phi + 2 / 15) * (K - 1)) / K ^ 2.

  (** The mean of weights that begin at layer m, by its certificate. *)
  Lemma mean_from m (F : R -> R) f : (j + 1 <= m <= M)%Z ->
    (forall l, (j + 1 <= l < m)%Z -> f l = 0) -> f m = F 0 ->
    (forall l, (m < l <= M)%Z -> f l = F (IZR (l - m)) - F (IZR (l - m) - 1)) ->
    Sum (j + 1) M f / K = F (IZR (M - m)) / K.
  Proof.
    intros H Z0 A S. f_equal.
    rewrite (Sum_telescope (fun l => on (m <=? l)%Z (F (IZR (l - m))))).
    - unfold on. replace (m <=? M)%Z with true by lia. replace (m <=? j + 1 - 1)%Z with false by lia. ring.
    - lia.
    - intros l Hl. destruct (Z.lt_trichotomy l m) as [L|[->|L]].
      + rewrite Z0 by lia. decide_on. ring.
      + rewrite A. decide_on. rewrite Z.sub_diag. ring.
      + rewrite S by lia. decide_on. rewrite !minus_IZR. f_equal. f_equal. ring.
  Qed.

  Ltac from_weights :=
    intros; unfold surface_weights; cbn [w_a w_b w_c]; unfold twice;
    rewrite ?Z.max_l, ?Z.max_r by lia; rewrite ?Z.sub_diag; decide_on; rewrite ?minus_IZR; ring.

  Lemma bulk_above m : (j + 2 <= m <= M)%Z -> let w := averaged j M (surface_weights G j) in
    let u := IZR (M - m) in
    w_a w m = (u + 1) * (u + 1 - phi) / K /\ w_b w m = - (2 * u * (u + 1) + (1 - phi)) / K /\
    w_c w m = u * (u + phi) / K.
  Proof.
    intros Hm. cbv zeta. unfold averaged. cbn [w_a w_b w_c]. repeat split.
    - apply (mean_from m (fun u => (u + 1) * (u + 1 - phi))); [lia|from_weights..].
    - apply (mean_from m (fun u => - (2 * u * (u + 1) + (1 - phi)))); [lia|from_weights..].
    - apply (mean_from m (fun u => u * (u + phi))); [lia|from_weights..].
  Qed.

  Lemma bulk_beside : let w := averaged j M (surface_weights G j) in
    w_a w (j + 1)%Z = K - 1 /\
    w_b w (j + 1)%Z = - 2 * (K - 1) + (1 - phi) * (K - 1) / K - (1 - phi) ^ 2 /\
    w_c w (j + 1)%Z = (K - 1) * (K - 1 + phi) / K.
  Proof.
    assert (P : 0 < K) by (apply (IZR_lt 0); lia).
    assert (E : IZR (M - (j + 1)) = K - 1) by (rewrite !minus_IZR, plus_IZR; ring).
    cbv zeta. unfold averaged. cbn [w_a w_b w_c]. repeat split.
    - rewrite (mean_from (j + 1) (fun u => u * (u + 1))); [rewrite E; field; lra|lia|from_weights..].
    - rewrite (mean_from (j + 1) (fun u =>
        - 2 * u * (u + 1) + (1 - phi) * u - (1 - phi) ^ 2 * (u + 1)));
        [rewrite E; field; lra|lia|from_weights..].
    - rewrite (mean_from (j + 1) (fun u => u * (u + phi))); [rewrite E; field; lra|lia|from_weights..].
  Qed.

  Theorem bulk_squares_are : squares M (layers i j (averaged j M (surface_weights G j))) = bulk_squares.
  Proof.
    assert (P : 0 < K) by (apply (IZR_lt 0); lia).
    rewrite squares_split.
    2:{ intros m Hm. unfold averaged. cbn [w_p w_q].
        split; (rewrite Sum_zero; [unfold Rdiv; ring|]; intros l Hl; unfold surface_weights; cbn [w_p w_q];
          decide_on; ring). }
    rewrite (squares_below ((K - 1) / 2)) by exact bulk_below.
    destruct bulk_beside as (-> & -> & ->). unfold bulk_squares. f_equal.
    rewrite (Sum_telescope (fun m => (6 / 5 * ((K - 1) ^ 5 - IZR (M - m) ^ 5)
      + (2 / 3 * phi ^ 2 - 10 / 3 * phi + 2 / 3) * ((K - 1) ^ 3 - IZR (M - m) ^ 3)
      + (4 / 3 * phi ^ 2 - 2 / 3 * phi + 2 / 15) * (K - 1 - IZR (M - m))) / K ^ 2)).
    - replace (M - (j + 2 - 1))%Z with (M - j - 1)%Z by lia. rewrite Z.sub_diag.
      rewrite (minus_IZR (M - j) 1). field. lra.
    - lia.
    - intros m Hm. destruct (bulk_above m Hm) as (-> & -> & ->).
      replace (M - (m - 1))%Z with (M - m + 1)%Z by lia. rewrite plus_IZR. field. lra.
  Qed.

End Squares.

(** ** How far they are from the printed forms *)

Section Near.
  Context (G : lattice) (j M : Z) (base : (0 <= j)%Z) (top : (j < M)%Z).
  Local Notation phi := (phi G).
  Local Notation K := (IZR (M - j)).

  (** What is left to show is of polynomials in k = M − j, in j if it is 2 or more, and in φ. *)
  Ltac layer_by_layer :=
    assert (E : IZR M = K + IZR j) by (rewrite minus_IZR; ring); rewrite E; clear E;
    pose proof (phi_above G); pose proof (phi_below G);
    assert (J : (j = 0%Z /\ IZR j = 0 \/ j = 1%Z /\ IZR j = 1) \/ (2 <= j)%Z /\ 2 <= IZR j)
      by (assert (C : (j = 0 \/ j = 1 \/ 2 <= j)%Z) by lia; destruct C as [->|[->|C]]; auto;
          right; split; [lia|apply (IZR_le 2); lia]);
    assert (T : (M = j + 1)%Z /\ K = 1 \/ (j + 2 <= M)%Z /\ 2 <= K)
      by (assert (C : (M = j + 1 \/ j + 2 <= M)%Z) by lia; destruct C as [->|C];
          [left; split; [lia|f_equal; lia]|right; split; [lia|apply (IZR_le 2); lia]]);
    unfold surface_squares, bulk_squares, below_squares, plain, beside, twice;
    destruct J as [[[? J]|[? J]]|[? J]], T as [[? T]|[? T]]; decide_on;
    generalize dependent K; generalize dependent (IZR j); generalize dependent phi;
    intros x ? ? a J k T; try subst a; try subst k;
    assert (0 <= x * x <= 1 / 4) by nra; assert (- (1 / 8) <= x * x * x <= 1 / 8) by nra;
    assert (0 <= x * x * x * x <= 1 / 16) by nra.

  (** Products of what is not negative, of k and of j. *)
  Ltac products x :=
    repeat match goal with
    | k : R, H : 2 <= ?k |- _ =>
        assert (0 <= k * (9 * x + 1) ^ 2) by (apply Rmult_le_pos; [lra|apply pow2_ge_0]);
        assert (0 <= k * (7 * x - 1) ^ 2) by (apply Rmult_le_pos; [lra|apply pow2_ge_0]);
        assert (0 <= k * (18 * x + 5) ^ 2) by (apply Rmult_le_pos; [lra|apply pow2_ge_0]);
        assert (0 <= k * (1 / 4 - x * x)) by (apply Rmult_le_pos; lra);
        assert (0 <= k * (x * x)) by (apply Rmult_le_pos; lra);
        assert (0 <= k * (1 / 2 - x)) by (apply Rmult_le_pos; lra);
        assert (0 <= k * (1 / 2 + x)) by (apply Rmult_le_pos; lra);
        assert (0 <= (k - 2) ^ 2) by apply pow2_ge_0; assert (0 <= (k - 67 / 20) ^ 2) by apply pow2_ge_0;
        revert H
    end; intros;
    try match goal with
    | Ha : 2 <= ?a, Hk : 2 <= ?k |- _ =>
        lazymatch k with a => fail | _ => idtac end; assert (0 <= (k - 2 * a - 19 / 18) ^ 2) by apply pow2_ge_0;
        assert (0 <= (a - 2 * k - 19 / 18) ^ 2) by apply pow2_ge_0;
        assert (0 <= (k - 2) * (a - 2)) by (apply Rmult_le_pos; lra)
    end.

  Theorem surface_near :
    Rabs (surface_squares G j M - 8 * K ^ 2 * (2 * IZR j + IZR M)) <= 4 * (2 * IZR M ^ 2 + IZR M).
  Proof. layer_by_layer; products x; apply Rabs_le; split; lra. Qed.

  Theorem bulk_near :
    Rabs (bulk_squares G j M - 6 / 5 * K ^ 2 * (4 * IZR j + IZR M)) <= 4 * (3 / 8 * IZR M ^ 2 + 5 / 4 * IZR M).
  Proof.
    layer_by_layer; products x;
      [apply Rabs_le; split; lra| |apply Rabs_le; split; lra| |apply Rabs_le; split; lra|];
      set (d := - 2 * x ^ 3 + 16 / 3 * x ^ 2 - 8 / 3 * x + 2 / 15);
      (assert (D : - 4 <= d <= 4) by (unfold d; lra));
      (assert (V : 0 < / k) by (apply Rinv_0_lt_compat; lra));
      (assert (V2 : / k <= 1 / 2) by (apply (Rmult_le_reg_l k); [lra|rewrite Rinv_r; lra]));
      (assert (0 <= (4 - d) * / k) by (apply Rmult_le_pos; lra));
      (assert (0 <= (4 + d) * / k) by (apply Rmult_le_pos; lra));
      [replace (_ - _) with (3 / 2 * k ^ 2 + k * (20 / 3 * x ^ 2 - 10 / 3 * x - 7 / 3)
         + 2 * x ^ 4 - 2 * x ^ 3 + 2 * x + 3 / 2 + d * / k) by (unfold d; field; lra)
      |replace (_ - _) with (3 / 2 * k ^ 2 + k * (26 / 3 * x ^ 2 + 11 / 3 * x - 10 / 3)
         + 2 * x ^ 4 + 8 * x ^ 2 + 3 * x + 5 / 2 + d * / k) by (unfold d; field; lra)
      |replace (_ - _) with (3 / 2 * k ^ 2 + k * (26 / 3 * x ^ 2 + 2 / 3 * x - 10 / 3)
         + 8 * a * x ^ 2 + 2 * a + 2 * x ^ 4 + 1 / 2 + d * / k) by (unfold d; field; lra)];
      clearbody d; apply Rabs_le; split; lra.
  Qed.
End Near.
