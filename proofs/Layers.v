(** The covariance of the forces of two contacts of one diagonal, in different layers (Eq. B12): products of their
    weights, added up exactly. *)

From Coq Require Import ZArith Reals Lia Lra List.
From ForceDiffusion Require Import Model Sums FirstOrder Lattice Geometry Mirror Forces Random Weights Exact Variances.
Import ListNotations.

Open Scope R_scope.
Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.

Section Products.
  Variable G : lattice.
  Variables i j l M : Z.
  Hypothesis inside_below : (2 <= j)%Z.
  Hypothesis apart : (j <= l - 2)%Z.
  Hypothesis inside_above : (l <= M - 2)%Z.
  Local Notation phi := (phi G).
  Local Notation lower := (surface_weights G j 1 M).
  Local Notation upper := (surface_weights G l 1 M).

  (** On the common diagonal; and where one contact's other diagonal crosses it. *)
  Definition along (m : Z) : R :=
    w_a lower m * w_a upper m + w_b lower m * w_b upper m + w_c lower m * w_c upper m.

  Lemma overlap_of_two m : overlap (layers i j lower m) (layers (i - j + l) l upper m) =
    along m + on (m =? j - 1)%Z (w_p lower m * w_c upper m)
    + on (m =? j)%Z (w_p lower m * w_b upper m + w_q lower m * w_c upper m)
    + on (m =? l - 1)%Z (w_c lower m * w_p upper m)
    + on (m =? l)%Z (w_b lower m * w_p upper m + w_c lower m * w_q upper m).
  Proof.
    assert (P : (j < m)%Z -> w_p lower m = 0 /\ w_q lower m = 0)
      by (intros; unfold surface_weights; cbn [w_p w_q]; decide_on; auto).
    assert (Q : (l < m)%Z -> w_p upper m = 0 /\ w_q upper m = 0)
      by (intros; unfold surface_weights; cbn [w_p w_q]; decide_on; auto).
    unfold along, layers. cbn [overlap on_one_radius].
    generalize dependent (w_p lower m). generalize dependent (w_q lower m).
    generalize dependent (w_p upper m). generalize dependent (w_q upper m).
    generalize (w_a lower m) (w_b lower m) (w_c lower m) (w_a upper m) (w_b upper m) (w_c upper m).
    intros a b c a' b' c' q' p' Q q p P.
    repeat match goal with
    | |- context [(?x =? ?y)%Z] =>
        lazymatch x with m => fail | _ => idtac end;
        first [replace (x =? y)%Z with true by lia|replace (x =? y)%Z with false by lia
              |replace (x =? y)%Z with (m =? j - 1)%Z by lia|replace (x =? y)%Z with (m =? j)%Z by lia
              |replace (x =? y)%Z with (m =? j + 1)%Z by lia|replace (x =? y)%Z with (m =? j + 2)%Z by lia
              |replace (x =? y)%Z with (m =? l - 1)%Z by lia|replace (x =? y)%Z with (m =? l)%Z by lia
              |replace (x =? y)%Z with (m =? l + 1)%Z by lia|replace (x =? y)%Z with (m =? l + 2)%Z by lia]
    end.
    destruct (Z.lt_ge_cases j m) as [J|J]; [destruct (P J) as [-> ->]|];
      (destruct (Z.lt_ge_cases l m) as [K|K]; [destruct (Q K) as [-> ->]|]); decide_on; ring.
  Qed.

  Ltac weights :=
    unfold surface_weights; cbn [w_a w_b w_c w_p w_q]; unfold twice;
    rewrite ?Z.max_l, ?Z.max_r by lia; decide_on;
    rewrite ?minus_IZR, ?plus_IZR, ?minus_IZR, ?plus_IZR; ring.

  Local Notation K := (IZR M - IZR j).
  Local Notation K' := (IZR M - IZR l).

  Lemma along_below m : (1 <= m <= j - 1)%Z ->
    along m = 4 * ((K - 1) * (K' - 1) + (2 * K - 1) * (2 * K' - 1) + K * K').
  Proof. intros. unfold along. weights. Qed.
  Lemma along_base : along 0 = (K - 1) * (K' - 1) + (2 * K - 1) * (2 * K' - 1) + K * K'.
  Proof. unfold along. weights. Qed.
  Lemma along_lower : along j = 4 * (K - 1) * (K' - 1)
    + (2 - 4 * K + phi * (1 - phi)) * (2 - 4 * K') + (2 * K - (1 - phi)) * (2 * K').
  Proof. unfold along. weights. Qed.
  Lemma along_next : along (j + 1) = 4 * (K - 1) * (K' - 1)
    + (- 4 * (K - 1) + (1 - phi) - (1 - phi) ^ 2) * (2 - 4 * K') + (2 * (K - 1) - (1 - phi)) * (2 * K').
  Proof. unfold along. weights. Qed.
  Lemma along_between m : (j + 2 <= m <= l - 1)%Z ->
    along m = (IZR M - IZR m) * (24 * K' - 12) - 2 * (1 - phi).
  Proof. intros. unfold along. weights. Qed.
  Lemma along_upper : along l = (2 * K' + (1 - phi)) * (2 * (K' - 1))
    - 4 * K' * (2 - 4 * K' + phi * (1 - phi)) + (2 * K' - (1 - phi)) * (2 * K' - (1 - phi)).
  Proof. unfold along. weights. Qed.
  Lemma along_over : along (l + 1) = (2 * (K' - 1) + (1 - phi)) * (2 * (K' - 1))
    - 4 * (K' - 1) * (- 4 * (K' - 1) + (1 - phi) - (1 - phi) ^ 2) + (2 * (K' - 1) - (1 - phi)) ^ 2.
  Proof. unfold along. weights. Qed.
  Lemma along_above m : (l + 2 <= m <= M)%Z ->
    along m = 24 * (IZR M - IZR m) ^ 2 + 2 * (1 - phi) ^ 2.
  Proof.
    intros. unfold along. destruct (Z.eq_dec m M) as [->|]; weights.
  Qed.

  Lemma crossing_lower : w_p lower (j - 1) * w_c upper (j - 1) = - 4 * phi * K' /\
    w_p lower j * w_b upper j + w_q lower j * w_c upper j = - 2 * phi * (2 - 4 * K') + 4 * phi * K'.
  Proof. split; weights. Qed.
  Lemma crossing_upper : w_c lower (l - 1) * w_p upper (l - 1) = - 2 * phi * (2 * K' + 1 + phi) /\
    w_b lower l * w_p upper l + w_c lower l * w_q upper l = 8 * phi * K' + 2 * phi * (2 * K' - (1 - phi)).
  Proof. split; weights. Qed.

  Theorem products_of_two : products M (layers i j lower) (layers (i - j + l) l upper) =
    K' * (8 * IZR M ^ 2 + 8 * IZR M * IZR l - 12 * IZR j ^ 2 - 4 * IZR l ^ 2)
    - 6 * IZR M * (IZR M + IZR j + IZR l) + 6 * (IZR j ^ 2 + IZR j * IZR l + IZR l ^ 2)
    + 2 * phi ^ 2 * (9 * K' - 4) + 2 * phi * (2 * IZR M - IZR j - IZR l - 2)
    - 8 * IZR M + 7 * IZR j + 9 * IZR l + 6.
  Proof.
    unfold products. rewrite (Sum_eq 0 M 0 M _ _ eq_refl eq_refl (fun m _ => overlap_of_two m)).
    rewrite !Sum_plus, !Sum_at by lia.
    rewrite (Sum_split 0 j M), (Sum_first 0 j), (Sum_last (0 + 1) j) by lia.
    rewrite (Sum_split (j + 1) l M), (Sum_first (j + 1) l), (Sum_last (j + 1 + 1) l), (Sum_first (l + 1) M) by lia.
    rewrite (Sum_eq (0 + 1) (j - 1) _ _ _ _ eq_refl eq_refl (fun m H => along_below m ltac:(lia))).
    rewrite (Sum_telescope (fun m => let v := IZR M - IZR m in
      - (24 * K' - 12) * (v * (v - 1) / 2) - 2 * (1 - phi) * IZR m) (j + 1 + 1) (l - 1))
      by (lia || (intros; cbv zeta; rewrite along_between, minus_IZR by lia; field)).
    rewrite (Sum_telescope (fun m => let v := IZR M - IZR m in
      - 4 * ((v - 1) * v * (2 * v - 1)) + 2 * (1 - phi) ^ 2 * IZR m) (l + 1 + 1) M)
      by (lia || (intros; cbv zeta; rewrite along_above, minus_IZR by lia; field)).
    rewrite Sum_const by lia. cbv zeta.
    destruct crossing_lower as [-> ->], crossing_upper as [-> ->].
    rewrite along_base, along_lower, along_next, along_upper, along_over.
    rewrite ?plus_IZR, ?minus_IZR, ?plus_IZR, ?minus_IZR, ?plus_IZR. field.
  Qed.
End Products.

(** The forces themselves, under a surface load. *)
Theorem covariance_of_layers G M W sigma (L : law W M sigma) (X : radii -> centres) (F : radii -> forces) i j l f :
  (forall rho, packing G M rho (X rho)) -> contact M i j -> (2 <= j)%Z -> (j <= l - 2)%Z -> (l <= M - 2)%Z ->
  (Z.abs i + 2 * M + 2 <= W)%Z -> 0 < f -> (forall rho, carries M (X rho) (surface M f) (F rho)) ->
  exists f1 f2, linearised (fun rho => f_plus (F rho) i j) f1 /\
    linearised (fun rho => f_plus (F rho) (i - j + l)%Z l) f2 /\
    relative_covariance L f1 f2 = unit_of G sigma / 4 *
      products M (layers i j (surface_weights G j 1 M)) (layers (i - j + l) l (surface_weights G l 1 M)).
Proof.
  intros P H J A T HW Hf C. pose proof (n_y_pos G). pose proof (r_pos G). pose proof (divisor_positive G).
  set (a := f / (2 * n_y G)). assert (Ha : 0 < a) by (apply Rdiv_lt_0_compat; lra).
  assert (At : forall i j, contact M i j -> linearised (fun rho => f_plus (F rho) i j)
    (linear_force G M i j a (surface_weights G j 1 M))).
  { intros i' j' H' rho. eexists _, _.
    split; [apply (surface_force G M rho (X rho) (P rho) (F rho) i' j' H' f (C rho))|]. fold a.
    unfold linear_force, whole. rewrite <- (surface_in_layers G rho i' j' ltac:(site) 1 M M) by site. field. lra. }
  assert (Inside : forall i j w, contact M i j -> (Z.abs i + M + 2 <= W)%Z ->
    forall m, (0 <= m <= M)%Z -> inside W M (layers i j w m) m) by (intros; apply layers_inside; assumption).
  assert (Form : forall i j rho, linear_force G M i j a (surface_weights G j 1 M) rho =
    a + a / (2 * r G * (1 - phi G * phi G)) * whole M (layers i j (surface_weights G j 1 M)) rho)
    by (intros; unfold linear_force; field; lra).
  eexists _, _. split; [apply At; exact H|split; [apply At; site|]].
  unfold relative_covariance.
  rewrite (form_mean W M sigma L _ (Inside _ _ _ H ltac:(lia)) a _ _ (Form i j)).
  pose proof (form_mean W M sigma L _ (Inside (i - j + l)%Z l _ ltac:(site) ltac:(lia)) a _ _
    (Form (i - j + l)%Z l)) as E.
  rewrite E, (form_covariance W M sigma L _ _ (Inside _ _ _ H ltac:(lia))
    (Inside (i - j + l)%Z l _ ltac:(site) ltac:(lia)) a _ _ a _ _ (Form i j) (Form (i - j + l)%Z l) E).
  unfold unit_of. field. repeat split; lra.
Qed.
