(** The response to a load on one bead, inside of its cone, as weights of single radii. Its variance, up to a
    bound, is what Eq. 16 says. *)

From Coq Require Import ZArith Reals Lia Lra List.
From ForceDiffusion Require Import Model Sums FirstOrder Lattice Geometry Mirror Forces Random Weights Variances.
Import ListNotations.

Open Scope R_scope.
Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.

(** ** Weights on one diagonal *)

Section Diagonal.
  Variable G : lattice.
  Local Notation phi := (phi G).

  (** The weights of 2r (1 − φ²) times the change of a force that turns at layer s: on the diagonal's
      bead of layer m, and on its neighbours towards (a) and away from (c) the turn. *)
  Definition turn_a (s m : Z) : R :=
    on (m <=? s - 1)%Z (twice m) + on (m =? s)%Z 2 + on (m =? s + 1)%Z (1 - phi).
  Definition turn_b (s m : Z) : R := on (m <=? s - 1)%Z (-2 * twice m) + on (m =? s)%Z (-2).
  Definition turn_c (s m : Z) : R := on (m <=? s - 1)%Z (twice m) - on (m =? s - 1)%Z (1 - phi).

  Lemma turn_sum s M (fa fb fc : Z -> R) : (1 <= s)%Z -> (s + 1 <= M)%Z ->
    Sum 0 M (fun m => turn_a s m * fa m + turn_b s m * fb m + turn_c s m * fc m) =
    (fa 0%Z - 2 * fb 0%Z + fc 0%Z) + 2 * Sum 1 (s - 1) (fun m => fa m - 2 * fb m + fc m)
    + 2 * (fa s - fb s) + (1 - phi) * (fa (s + 1)%Z - fc (s - 1)%Z).
  Proof.
    intros Hs HM.
    rewrite (Sum_eq 0 M 0 M _ (fun m =>
      on (m <=? s - 1)%Z (twice m * (fa m - 2 * fb m + fc m)) + on (m =? s)%Z (2 * (fa m - fb m))
      + on (m =? s + 1)%Z ((1 - phi) * fa m) + on (m =? s - 1)%Z (- (1 - phi) * fc m))).
    2, 3: reflexivity.
    2:{ intros m Hm. unfold turn_a, turn_b, turn_c. decide_on; ring. }
    do 3 rewrite Sum_plus. rewrite Sum_up_to, !Sum_at, Sum_twice by lia. ring.
  Qed.

  Lemma turn_bounds s m : Rabs (turn_a s m) <= 2 /\ Rabs (turn_b s m) <= 4 /\ Rabs (turn_c s m) <= 2.
  Proof.
    real_bounds G. unfold turn_a, turn_b, turn_c, twice.
    repeat split; apply Rabs_le; decide_on; lra.
  Qed.

  (** One for each exceptional layer of a diagonal: the base, and the three at the turn. *)
  Definition at_turn (s m : Z) : R :=
    on (m =? 0)%Z 8 + on (m =? s - 1)%Z 8 + on (m =? s)%Z 8 + on (m =? s + 1)%Z 8.

  Lemma turn_square s m : (0 <= m)%Z ->
    Rabs (turn_a s m * turn_a s m + turn_b s m * turn_b s m + turn_c s m * turn_c s m
      - on ((1 <=? m) && (m <=? s - 1))%bool%Z 24) <= at_turn s m.
  Proof.
    intros Hm. real_bounds G. unfold turn_a, turn_b, turn_c, twice, at_turn.
    apply Rabs_le. decide_on; lra.
  Qed.
End Diagonal.

Lemma Sum_at_most low high a x : 0 <= x -> Sum low high (fun m => on (m =? a)%Z x) <= x.
Proof.
  intros H. destruct (Z.le_gt_cases low a) as [H1|H1]; [destruct (Z.le_gt_cases a high) as [H2|H2]|].
  - rewrite (Sum_at low high a (fun _ => x)) by lia. lra.
  - rewrite Sum_zero; [exact H|]. intros m Hm. unfold on. replace (m =? a)%Z with false by lia. auto.
  - rewrite Sum_zero; [exact H|]. intros m Hm. unfold on. replace (m =? a)%Z with false by lia. auto.
Qed.

Lemma Sum_counted s M : (1 <= s <= M)%Z ->
  Sum 0 M (fun m => on ((1 <=? m) && (m <=? s - 1))%bool%Z 24) = 24 * IZR (s - 1).
Proof.
  intros H. rewrite Sum_first by lia. unfold on at 1. cbn [Z.leb Z.compare andb].
  rewrite (Sum_eq (0 + 1) M 1 M _ (fun m => on (m <=? s - 1)%Z 24)).
  - rewrite Sum_up_to, Sum_const by lia. replace (s - 1 - 1 + 1)%Z with (s - 1)%Z by lia. ring.
  - lia.
  - reflexivity.
  - intros m Hm. replace (1 <=? m)%Z with true by lia. reflexivity.
Qed.

(** ** Both diagonals through a bead *)

Section Cone.
  Context (G : lattice) (M W i j p q : Z).
  Hypothesis at_bead : bead M i j.
  Hypothesis inside_p : (1 <= p)%Z.
  Hypothesis inside_q : (1 <= q)%Z.
  Hypothesis below : (j + p + q <= M)%Z.
  Hypothesis no_boundary : (Z.abs i + M + 2 <= W)%Z.
  Local Notation phi := (phi G).
  Local Notation r := (r G).
  Local Notation s := (j + p)%Z.
  Local Notation t := (j + q)%Z.

  Definition cone_layers (m : Z) : layer :=
    [(turn_a G s m, i - j + m - 2); (turn_b s m, i - j + m); (turn_c G s m, i - j + m + 2);
     (turn_a G t m, i + j - m + 2); (turn_b t m, i + j - m); (turn_c G t m, i + j - m - 2)]%Z.

  Lemma cone_layers_inside m : (0 <= m <= M)%Z -> inside W M (cone_layers m) m.
  Proof.
    intros Hm. unfold inside, cone_layers, within, bead in *.
    repeat (apply Forall_cons; [cbn [snd]; lia|]). apply Forall_nil.
  Qed.

  Theorem response_in_layers rho :
    - (2 * r * (tilt_minus G rho (i + p + 1) (j + p - 1) - tilt_minus G rho (i + p) (j + p)))
    - 2 * r * (tilt_plus G rho (i - q - 1) (j + q - 1) - tilt_plus G rho (i - q) (j + q)) =
    whole M cone_layers rho.
  Proof.
    unfold whole.
    rewrite (Sum_eq 0 M 0 M _ (fun m =>
      (turn_a G s m * rho (i - j + m - 2)%Z m + turn_b s m * rho (i - j + m)%Z m
        + turn_c G s m * rho (i - j + m + 2)%Z m)
      + (turn_a G t m * rho (i + j - m + 2)%Z m + turn_b t m * rho (i + j - m)%Z m
        + turn_c G t m * rho (i + j - m - 2)%Z m))).
    2, 3: reflexivity.
    2:{ intros m Hm. unfold cone_layers. cbn [weigh]. ring. }
    rewrite Sum_plus.
    rewrite (turn_sum G s M (fun m => rho (i - j + m - 2)%Z m) (fun m => rho (i - j + m)%Z m)
      (fun m => rho (i - j + m + 2)%Z m)) by site.
    rewrite (turn_sum G t M (fun m => rho (i + j - m + 2)%Z m) (fun m => rho (i + j - m)%Z m)
      (fun m => rho (i + j - m - 2)%Z m)) by site.
    unfold Rminus at 1. f_equal.
    - rewrite Rmult_minus_distr_l, !tilt_minus_is by site. rewrite !(Sum_last 1 (j + p)) by site.
      normal_form. ring.
    - rewrite Rmult_minus_distr_l, !tilt_plus_is by site. rewrite !(Sum_last 1 (j + q)) by site.
      normal_form. ring.
  Qed.

  (** ** The sum of squared weights *)

  (** Where the two diagonals cross. *)
  Definition crossing (m : Z) : R :=
    on (m =? j - 2)%Z 128 + on (m =? j - 1)%Z 128 + on (m =? j)%Z 128
    + on (m =? j + 1)%Z 128 + on (m =? j + 2)%Z 128.

  Lemma pair_bounds (b : bool) x y u v : Rabs x <= u -> Rabs y <= v ->
    - (u * v) <= (if b then x * y else 0) <= u * v.
  Proof.
    intros Hx Hy. pose proof (Rabs_pos x). pose proof (Rabs_pos y).
    assert (Rabs (x * y) <= u * v) by (rewrite Rabs_mult; apply Rmult_le_compat; lra).
    assert (0 <= u * v) by (apply Rmult_le_pos; lra).
    destruct b; [apply Rabs_def2'; assumption|lra].
  Qed.

  Lemma cone_layer_square m : (0 <= m)%Z ->
    Rabs (overlap (cone_layers m) (cone_layers m)
      - (on ((1 <=? m) && (m <=? s - 1))%bool%Z 24 + on ((1 <=? m) && (m <=? t - 1))%bool%Z 24))
    <= at_turn s m + at_turn t m + crossing m.
  Proof.
    intros Hm. pose proof (turn_square G s m Hm) as S. pose proof (turn_square G t m Hm) as T.
    destruct (turn_bounds G s m) as (Ba & Bb & Bc). destruct (turn_bounds G t m) as (Da & Db & Dc).
    unfold cone_layers. cbn [overlap on_one_radius].
    set (a := turn_a G s m) in *. set (b := turn_b s m) in *. set (c := turn_c G s m) in *.
    set (d := turn_a G t m) in *. set (e := turn_b t m) in *. set (f := turn_c G t m) in *.
    set (A := (i - j + m - 2)%Z). set (C := (i - j + m + 2)%Z). set (B := (i - j + m)%Z).
    set (D := (i + j - m + 2)%Z). set (F := (i + j - m - 2)%Z). set (E := (i + j - m)%Z).
    compare_indices.
    rewrite (Z.eqb_sym D A), (Z.eqb_sym D B), (Z.eqb_sym D C).
    rewrite (Z.eqb_sym E A), (Z.eqb_sym E B), (Z.eqb_sym E C).
    rewrite (Z.eqb_sym F A), (Z.eqb_sym F B), (Z.eqb_sym F C).
    rewrite (Rmult_comm d a), (Rmult_comm d b), (Rmult_comm d c).
    rewrite (Rmult_comm e a), (Rmult_comm e b), (Rmult_comm e c).
    rewrite (Rmult_comm f a), (Rmult_comm f b), (Rmult_comm f c).
    apply Rabs_def2' in S. apply Rabs_def2' in T. unfold crossing.
    destruct (Z.le_gt_cases 3 (Z.abs (m - j))) as [Far|Near].
    - compare_indices. unfold on at 3 4 5 6 7.
      apply Rabs_le. lra.
    - assert (X : 128 <= on (m =? j - 2)%Z 128 + on (m =? j - 1)%Z 128 + on (m =? j)%Z 128
        + on (m =? j + 1)%Z 128 + on (m =? j + 2)%Z 128) by (decide_on; lra || lia).
      pose proof (pair_bounds (A =? D)%Z a d _ _ Ba Da). pose proof (pair_bounds (A =? E)%Z a e _ _ Ba Db).
      pose proof (pair_bounds (A =? F)%Z a f _ _ Ba Dc). pose proof (pair_bounds (B =? D)%Z b d _ _ Bb Da).
      pose proof (pair_bounds (B =? E)%Z b e _ _ Bb Db). pose proof (pair_bounds (B =? F)%Z b f _ _ Bb Dc).
      pose proof (pair_bounds (C =? D)%Z c d _ _ Bc Da). pose proof (pair_bounds (C =? E)%Z c e _ _ Bc Db).
      pose proof (pair_bounds (C =? F)%Z c f _ _ Bc Dc).
      apply Rabs_le. lra.
  Qed.

  Theorem cone_squares : Rabs (squares M cone_layers - 24 * (IZR (j + p + q) + IZR j)) <= 752.
  Proof.
    assert (E : 24 * (IZR (j + p + q) + IZR j) =
      Sum 0 M (fun m => on ((1 <=? m) && (m <=? s - 1))%bool%Z 24 + on ((1 <=? m) && (m <=? t - 1))%bool%Z 24) + 48).
    { rewrite Sum_plus, !Sum_counted by site. rewrite !minus_IZR, !plus_IZR. ring. }
    assert (B : Rabs (Sum 0 M (fun m => overlap (cone_layers m) (cone_layers m)
      - (on ((1 <=? m) && (m <=? s - 1))%bool%Z 24 + on ((1 <=? m) && (m <=? t - 1))%bool%Z 24))) <= 704).
    { eapply Rle_trans; [apply Sum_abs|].
      eapply Rle_trans; [apply Sum_le; intros; apply cone_layer_square; lia|].
      unfold at_turn, crossing. rewrite !Sum_plus.
      repeat match goal with
      | |- context [Sum 0 M (fun m => on (m =? ?a)%Z ?x)] =>
          let N := fresh in pose proof (Sum_at_most 0 M a x ltac:(lra)) as N;
          set (Sum 0 M (fun m => on (m =? a)%Z x)) in *
      end. lra. }
    rewrite Sum_minus in B. unfold squares. apply Rabs_def2' in B. apply Rabs_le. lra.
  Qed.

  (** ** The response *)

  Lemma pressed_down_expands rho X F f :
    packing G M rho X -> carries M X (single (i + p - q) (j + p + q) f) F ->
    expands (pressed_down X F i j) 0
      (f / 2 * (1 / (2 * r * (1 - phi * phi)) * whole M cone_layers rho)).
  Proof.
    intros P C. pose proof (n_y_pos G). pose proof (r_pos G). pose proof (divisor_positive G).
    assert (K : bead M (i + p - q) (j + p + q)) by site.
    destruct (single_force G M rho X P F (i + p - q) (j + p + q) f K ltac:(site) C j ltac:(lia) i
      ltac:(site)) as [Ep Em].
    destruct (push_plus G M rho X P _ F C i j _ _ at_bead Ep) as [_ Yp].
    destruct (push_minus G M rho X P _ F C i j _ _ at_bead Em) as [_ Ym].
    apply (expands_near (fun e => y_of (scale (f_plus F i j e) (N_plus X i j e))
      + y_of (scale (f_minus F i j e) (N_minus X i j e)))).
    2:{ apply near_always. intros e. reflexivity. }
    assert (O1 : ordered_plus (i + p - q) (j + p + q) i j = 0)
      by (unfold ordered_plus; decide_conditions; reflexivity).
    assert (O2 : ordered_minus (i + p - q) (j + p + q) i j = 0)
      by (unfold ordered_minus, ordered_plus; decide_conditions; reflexivity).
    assert (R1 : response_plus G rho (i + p - q) (j + p + q) i j =
      - ((tilt_minus G rho (i + p + 1) (j + p - 1) - tilt_minus G rho (i + p) (j + p)) / (1 - phi * phi))).
    { unfold response_plus. cbv zeta. replace (turn_plus _ _ i j) with p by (unfold turn_plus; lia).
      decide_conditions. reflexivity. }
    assert (R2 : response_minus G rho (i + p - q) (j + p + q) i j =
      - ((tilt_plus G rho (i - q - 1) (j + q - 1) - tilt_plus G rho (i - q) (j + q)) / (1 - phi * phi))).
    { unfold response_minus, response_plus. cbv zeta.
      replace (turn_plus _ _ (- i) j) with q by (unfold turn_plus; lia).
      rewrite !tilt_minus_mirrored. decide_conditions. same_values. reflexivity. }
    rewrite O1, R1 in Yp. rewrite O2, R2 in Ym.
    eapply expands_to; [apply expands_plus; [exact Yp|exact Ym]|field; lra|].
    rewrite <- response_in_layers. field. lra.
  Qed.

  Theorem response_variance sigma (L : law W M sigma) (Xs : radii -> centres) (Fs : radii -> forces) f :
    0 < sigma -> 0 < f ->
    (forall rho, packing G M rho (Xs rho)) ->
    (forall rho, carries M (Xs rho) (single (i + p - q) (j + p + q) f) (Fs rho)) ->
    exists f1, linearised (fun rho => pressed_down (Xs rho) (Fs rho) i j) f1 /\
      Rabs (variance L f1 / f ^ 2 - unit_of G sigma * (3 / 2 * (IZR (j + p + q) + IZR j)))
        <= 47 * unit_of G sigma.
  Proof.
    intros Hs Hf P C. pose proof (r_pos G). pose proof (divisor_positive G).
    exists (fun rho => 0 + f / 2 * (1 / (2 * r * (1 - phi * phi)) * whole M cone_layers rho)).
    split.
    - intros rho. eexists _, _. split; [apply (pressed_down_expands rho); auto|reflexivity].
    - destruct (form_variance W M sigma L cone_layers cone_layers_inside 0
        (f / 2 * (1 / (2 * r * (1 - phi * phi))))
        (fun rho => 0 + f / 2 * (1 / (2 * r * (1 - phi * phi)) * whole M cone_layers rho))) as [_ V].
      { intros rho. ring. }
      rewrite V.
      replace ((f / 2 * (1 / (2 * r * (1 - phi * phi)))) ^ 2 * (sigma ^ 2 * squares M cone_layers) / f ^ 2)
        with (unit_of G sigma * (squares M cone_layers / 16)) by (unfold unit_of; field; lra).
      pose proof (unit_positive G sigma Hs) as U. pose proof cone_squares as S.
      rewrite <- Rmult_minus_distr_l, Rabs_mult, (Rabs_right (unit_of G sigma)) by lra.
      rewrite Rmult_comm. apply Rmult_le_compat_r; [lra|].
      apply Rabs_def2' in S. apply Rabs_le. lra.
  Qed.
End Cone.
